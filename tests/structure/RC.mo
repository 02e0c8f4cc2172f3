model RC
  parameter Real R = 10;
  parameter Real C = 0.01;
  Real vR;
  Real vC(start = 0);
  Real i;
  Real iC;
  Real v0;
equation
  v0 = 5;
  v0 = vR + vC;
  vR = R*i;
  iC = C*der(vC);
  iC = -(-i);
end RC;
