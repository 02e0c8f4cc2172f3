model Vessel
  parameter Real k = 0.1;
  parameter Real h0 = 1;
  Real h(start = h0, fixed = true);
  output Real y = h;
equation
  der(h) = -k*sqrt(max(h, 0));
  annotation(experiment(StopTime = 8, Tolerance = 1e-9));
end Vessel;
