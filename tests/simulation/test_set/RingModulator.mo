model RingModulator "Two signals multiplied by four diodes"
  constant Real pi = 3.141592653589793;
  parameter Real C = 1.6e-8; parameter Real Cs = 2e-12; parameter Real Cp = 1e-8;
  parameter Real Lh = 4.45; parameter Real Ls1 = 0.002; parameter Real Ls2 = 5e-4; parameter Real Ls3 = 5e-4;
  parameter Real R = 25000; parameter Real Rp = 50; parameter Real Ri = 50; parameter Real Rc = 600;
  parameter Real Rg1 = 36.3; parameter Real Rg2 = 17.3; parameter Real Rg3 = 17.3;
  parameter Real gamma = 40.67286402e-9; parameter Real delta = 17.7493332;
  Real y[15](each start = 0, each fixed = true,
    nominal = {0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 1e-6, 1e-6, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3});
  Real u1; Real u2; Real q[4];
equation
  u1 = 0.5*sin(2000*pi*time);
  u2 = 2*sin(20000*pi*time);
  q[1] = gamma*(exp(delta*(y[3] - y[5] - y[7] - u2)) - 1);
  q[2] = gamma*(exp(delta*(-y[4] + y[6] - y[7] - u2)) - 1);
  q[3] = gamma*(exp(delta*(y[4] + y[5] + y[7] + u2)) - 1);
  q[4] = gamma*(exp(delta*(-y[3] - y[6] + y[7] + u2)) - 1);
  C*der(y[1]) = y[8] - 0.5*y[10] + 0.5*y[11] + y[14] - y[1]/R;
  C*der(y[2]) = y[9] - 0.5*y[12] + 0.5*y[13] + y[15] - y[2]/R;
  Cs*der(y[3]) = y[10] - q[1] + q[4];
  Cs*der(y[4]) = -y[11] + q[2] - q[3];
  Cs*der(y[5]) = y[12] + q[1] - q[3];
  Cs*der(y[6]) = -y[13] - q[2] + q[4];
  Cp*der(y[7]) = -y[7]/Rp + q[1] + q[2] - q[3] - q[4];
  Lh*der(y[8]) = -y[1];
  Lh*der(y[9]) = -y[2];
  Ls2*der(y[10]) = 0.5*y[1] - y[3] - Rg2*y[10];
  Ls3*der(y[11]) = -0.5*y[1] + y[4] - Rg3*y[11];
  Ls2*der(y[12]) = 0.5*y[2] - y[5] - Rg2*y[12];
  Ls3*der(y[13]) = -0.5*y[2] + y[6] - Rg3*y[13];
  Ls1*der(y[14]) = -y[1] + u1 - (Ri + Rg1)*y[14];
  Ls1*der(y[15]) = -y[2] - (Rc + Rg1)*y[15];
end RingModulator;
