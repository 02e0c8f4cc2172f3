model NTC
  parameter Real R25 = 10;
  parameter Real B = 3000;
  Real T = 275 + 70*time;
  output Real R = R25*exp(B*(1/T - 1/298.15));
  annotation(experiment(StopTime = 1, Interval = 0.0005));
end NTC;
