model Tasse
  parameter Real Ta = 20;
  parameter Real tau = 10;
  Real T(start = 90, fixed = true);
  output Real y = T;
equation
  tau*der(T) = Ta - T;
  annotation(experiment(StopTime = 30, Tolerance = 1e-8));
end Tasse;
