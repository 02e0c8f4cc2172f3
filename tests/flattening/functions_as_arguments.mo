// MLS §12.4.2: functions and partial applications are written into copies of what they are passed to.
package functions_as_arguments
  partial function Integrand
    input Real x;
    output Real y;
  end Integrand;
  function trapezium
    input Real a;
    input Real b;
    input Integrand f;
    output Real area;
  algorithm
    area := (b - a)*(f(a) + f(b))/2;
  end trapezium;
  function halves
    input Real a;
    input Real b;
    input Integrand f;
    output Real area;
  algorithm
    area := trapezium(a, (a + b)/2, f) + trapezium((a + b)/2, b, f);
  end halves;
  function square
    extends Integrand;
  algorithm
    y := x*x;
  end square;
  function sine
    extends Integrand;
    input Real amplitude;
  algorithm
    y := amplitude*sin(x);
  end sine;
  model Main
    Real x = halves(0, 1, square);
    Real y = halves(0, time, function sine(amplitude = 2));
    Real z[2] = square({1, time});
  end Main;
end functions_as_arguments;
