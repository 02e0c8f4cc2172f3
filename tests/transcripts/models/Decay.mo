model Decay "Exponential decay"
  parameter Real k(min = 0) = 1 "rate";
  parameter Integer n = 2 "number of copies";
  Real x(start = 1, fixed = true) "amount";
  Real y[n] "copies";
equation
  der(x) = -k*x;
  y = fill(2*x, n);
  annotation(experiment(StopTime = 2, Tolerance = 1e-6));
end Decay;
