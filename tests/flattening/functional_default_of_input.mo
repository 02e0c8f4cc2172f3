package functional_default_of_input "MLS 12.4.2: the function that is meant where none is passed"
  partial function Integrand
    input Real u;
    output Real y;
  end Integrand;
  function square
    extends Integrand;
  algorithm
    y := u*u;
  end square;
  function cube
    extends Integrand;
  algorithm
    y := u^3;
  end cube;
  function trapezoid
    input Real a;
    input Real b;
    input Integrand integrand = square;
    output Real integral;
  algorithm
    integral := (b - a)*(integrand(a) + integrand(b))/2;
  end trapezoid;
  function twice
    input Real b;
    output Real y;
  algorithm
    y := 2*trapezoid(0, b);
  end twice;
  model Main
    Real p = trapezoid(0, time);
    Real q = trapezoid(0, time, cube);
    Real r = twice(time);
  end Main;
end functional_default_of_input;
