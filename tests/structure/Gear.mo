model Gear
  Real phi1(start = 0.6, fixed = true);
  Real w1(fixed = true);
  Real phi2;
  Real w2;
  Real tau1;
  Real tau2;
  parameter Real i = -3;
  parameter Real J1 = 1;
  parameter Real J2 = 9;
equation
  der(phi1) = w1;
  der(phi2) = w2;
  phi1 = i*phi2;
  0 = i*tau1 + tau2;
  J1*der(w1) = -8*phi1 + tau1;
  J2*der(w2) = tau2;
end Gear;
