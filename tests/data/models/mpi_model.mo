model Oscillator
  parameter Real mu = 1;
  parameter Real w = 1;
  parameter Real d = 0.1;
  Real x(start = 2, fixed = true);
  Real v(start = 0, fixed = true);
equation
  der(x) = w*v;
  der(v) = mu*(1 - x^2)*v - w*x - d*v;
  annotation(experiment(StopTime = 10, Tolerance = 1e-8));
end Oscillator;
