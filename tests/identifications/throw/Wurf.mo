model Wurf
  parameter Real v = 10;
  parameter Real g = 10;
  Real h(start = 0, fixed = true);
equation
  der(h) = v - g*time;
  annotation(experiment(StopTime = 1.5, Tolerance = 1e-8));
end Wurf;
