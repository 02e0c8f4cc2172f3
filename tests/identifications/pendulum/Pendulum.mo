model Pendulum
  parameter Real L = 1;
  parameter Real a0 = 0.1;
  Real phi(start = a0, fixed = true);
  Real w(start = 0, fixed = true);
  output Real y = phi;
equation
  der(phi) = w;
  L*der(w) = -9.81*phi;
  annotation(experiment(StopTime = 3, Tolerance = 1e-8));
end Pendulum;
