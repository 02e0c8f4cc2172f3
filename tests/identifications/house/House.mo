model House "warm air and the weather"
  parameter Real Ta = 0;
  parameter Real tau = 10;
  parameter Real T0 = 20;
  Real T(start = T0, fixed = true);
  output Real indoor = T;
equation
  der(T) = (Ta - T)/tau;
  annotation(experiment(StopTime = 24, Tolerance = 1e-8));
end House;
