model Main
  function f
    input Real u;
    input Real k;
    output Real y;
  protected
    Integer n = 0;
  algorithm
    while n < 1 and u < 9 loop
      n := n + 1;
      y := sin(k*u);
    end while;
    annotation (derivative(noDerivative = k) = slope);
  end f;
  function slope
    input Real u;
    input Real k;
    input Real du;
    output Real dy;
  protected
    Integer n = 0;
  algorithm
    while n < 1 and u < 9 loop
      n := n + 1;
      dy := 7*k*cos(k*u)*du;
    end while;
    annotation (derivative(noDerivative = k, order = 2) = bend);
  end slope;
  function bend
    input Real u;
    input Real k;
    input Real du;
    input Real ddu;
    output Real ddy;
  protected
    Integer n = 0;
  algorithm
    while n < 1 and u < 9 loop
      n := n + 1;
      ddy := 70*k*cos(k*u)*ddu - 700*k^2*sin(k*u)*du^2;
    end while;
  end bend;
  Real x(start = 0.3, fixed = true);
  Real y;
  Real w;
  Real a;
equation
  der(x) = cos(time) + x;
  y = f(x, 2);
  w = der(y);
  a = der(w);
end Main;
