// A size that depends on itself.
model size_cycle
  parameter Integer n = m;
  parameter Integer m = n;
  Real x[n] = zeros(n);
end size_cycle;
