model TransistorAmplifier "Two transistors; capacitors between the nodes y"
  parameter Real Ub = 6; parameter Real UF = 0.026; parameter Real alpha = 0.99; parameter Real beta = 1e-6;
  parameter Real R0 = 1000; parameter Real R = 9000; parameter Real C[5] = {1e-6, 2e-6, 3e-6, 4e-6, 5e-6};
  Real y[8]; Real Ue; Real g1; Real g2;
  Real u1(start = -3, fixed = true); Real u3(start = 3, fixed = true); Real u5(start = 6, fixed = true);
  Real u2(start = 3, fixed = true); Real u4(start = 3, fixed = true);
  Real i1; Real i3; Real i5;
equation
  Ue = 0.1*sin(628.3185307179586*time);
  g1 = beta*(exp((y[2] - y[3])/UF) - 1); g2 = beta*(exp((y[5] - y[6])/UF) - 1);
  u1 = y[1] - y[2]; u2 = y[3]; u3 = y[4] - y[5]; u4 = y[6]; u5 = y[7] - y[8];
  i1 = C[1]*der(u1); i3 = C[3]*der(u3); i5 = C[5]*der(u5);
  -i1 = (y[1] - Ue)/R0;
  i1 = -Ub/R + 2*y[2]/R - (alpha - 1)*g1;
  -C[2]*der(u2) = -g1 + y[3]/R;
  -i3 = (y[4] - Ub)/R + alpha*g1;
  i3 = -Ub/R + 2*y[5]/R - (alpha - 1)*g2;
  -C[4]*der(u4) = -g2 + y[6]/R;
  -i5 = (y[7] - Ub)/R + alpha*g2;
  i5 = y[8]/R;
end TransistorAmplifier;
