model Pendulum
  parameter Real L = 2;
  parameter Real g = 9.81;
  Real x(start = 1.2, fixed = true);
  Real y(start = -1.6);
  Real u(start = 0, fixed = true);
  Real v;
  Real F;
equation
  der(x) = u;
  der(y) = v;
  der(u) = -F*x/L;
  der(v) = -F*y/L - g;
  x^2 + y^2 = L^2;
end Pendulum;
