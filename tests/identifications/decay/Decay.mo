model Decay
  parameter Real k = 1;
  parameter Real x0 = 1;
  Real x(start = x0, fixed = true);
  output Real m = x;
equation
  der(x) = -k*x;
  annotation(experiment(StopTime = 5, Tolerance = 1e-8));
end Decay;
