within Modelica.Electrical.Analog.Basic;
model M_Transformer "Any number of coupled inductors"
  parameter Integer N(final min = 1) = 3 "number of inductors";
protected
  parameter Integer dimL = div(N*(N + 1), 2) "number of inductances";
public
  parameter SI.Inductance L[dimL] = {1, 0.1, 0.2, 2, 0.3, 3}
    "inductances: upper half of the symmetric matrix, row by row";
  Interfaces.PositivePin p[N] "positive pins";
  Interfaces.NegativePin n[N] "negative pins";
  SI.Voltage v[N] "voltages";
  SI.Current i[N](each start = 0, each fixed = true) "currents";
  final parameter SI.Inductance Lm[N, N] = {{
    L[div((min(a, b) - 1)*(2*N - min(a, b)), 2) + max(a, b)] for b in 1:N} for a in 1:N}
    "matrix of the inductances";
equation
  for a in 1:N loop
    v[a] = p[a].v - n[a].v;
    i[a] = p[a].i;
    p[a].i + n[a].i = 0;
  end for;
  v = Lm*der(i);
end M_Transformer;
