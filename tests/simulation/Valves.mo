model Valves "pipes between equal vessels: all flows start at zero and take what is upstream"
  parameter Integer n = 12;
  Real p[n](each start = 1e5, each fixed = true, each nominal = 1e5);
  Real c[n](start = {i for i in 1:n}, each fixed = true);
  Real f[n + 1];
  Real h[n + 1];
equation
  f[1] = 1e-5*(1e5 + 100*time - p[1]);
  h[1] = if f[1] > 0 then 0 else c[1];
  for i in 2:n loop
    f[i] = 1e-5*(p[i - 1] - p[i]);
    h[i] = if f[i] > 0 then c[i - 1] else c[i];
  end for;
  f[n + 1] = 0;
  h[n + 1] = if f[n + 1] > 0 then c[n] else 0;
  for i in 1:n loop
    der(p[i]) = 1e6*(f[i] - f[i + 1]);
    der(c[i]) = 10*(f[i]*(h[i] - c[i]) - f[i + 1]*(h[i + 1] - c[i]));
  end for;
end Valves;
