model Reaction
  parameter Real k = 0.1;
  parameter Real c0 = 1;
  Real c(start = c0, fixed = true);
equation
  der(c) = -k*c^2;
  annotation(experiment(StopTime = 10, Tolerance = 1e-9));
end Reaction;
