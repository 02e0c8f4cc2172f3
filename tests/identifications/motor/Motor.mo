model Motor
  parameter Real tau = 1;
  constant Real n0 = 100;
  Real n(start = 0, fixed = true);
  output Real speed = n;
equation
  der(n) = (n0 - n)/tau;
  annotation(experiment(StopTime = 5, Tolerance = 1e-9));
end Motor;
