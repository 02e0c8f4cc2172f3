model Mola
  parameter Real w = 1;
  parameter Real d = 0.1;
  Real x(start = 1, fixed = true);
  Real v(start = 0, fixed = true);
  output Real y = x;
equation
  der(x) = v;
  der(v) = -2*d*v - w^2*x;
  annotation(experiment(StopTime = 6, Tolerance = 1e-8));
end Mola;
