model Sensor
  parameter Real K = 1;
  parameter Real tau = 1;
  Real x(start = 0, fixed = true);
  output Real y = x;
equation
  tau*der(x) + x = K*time;
  annotation(experiment(StopTime = 5, Tolerance = 1e-10));
end Sensor;
