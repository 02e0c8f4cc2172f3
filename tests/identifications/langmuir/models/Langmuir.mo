model Langmuir
  parameter Real q = 1;
  parameter Real K = 1;
  Real p = time;
  output Real load = q*K*p/(1 + K*p);
  annotation(experiment(StopTime = 4, Interval = 0.001));
end Langmuir;
