model Electrode
  input Real i(unit = "A");
  output Real v(unit = "V");
  parameter Real Rm(unit = "Ohm") = 0.05;
  parameter Real Rct(unit = "Ohm") = 0.2;
  parameter Real Q = 0.03;
  parameter Real alpha = 0.9;
  GAPILib.Impedance.ConstantPhaseElement layer(Q = Q, alpha = alpha, fMin = 0.01, fMax = 1e5);
  Real faradaic(unit = "A");
equation
  i = layer.i + faradaic;
  layer.v = Rct*faradaic;
  v = Rm*i + layer.v;
end Electrode;
