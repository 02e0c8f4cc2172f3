model Cell
  parameter Real k = 1;
  Real x(start = 1, fixed = true);
equation
  der(x) = -k*x;
end Cell;
model Stack
  Cell c[2](k = {1, 2});
  parameter Real p[2] = {1, 1};
  input Real u[2] = {0, 0};
  output Real y = p[1]*c[1].x + p[2]*c[2].x;
end Stack;
model Rods
  parameter Integer n = 2;
  parameter Boolean heated = false;
  parameter Real k = 1;
  final parameter Real other = 1;
  Real T[n](each start = 1, each fixed = true);
  Real twice = 2*T[1];
  output Real y = T[n];
equation
  der(T[1]) = -k*T[1] + (if heated then 1 else 0);
  for i in 2:n loop
    der(T[i]) = k*(T[i - 1] - T[i]);
  end for;
end Rods;
model Valve
  input Boolean open;
  input Integer level;
  parameter Real K = 1;
  parameter Real T = 1;
  Real y(start = 0, fixed = true);
  output Boolean high = y > 1;
equation
  T*der(y) = (if open then K*level else 0) - y;
end Valve;
model Mixer
  input Real u[2];
  parameter Real K = 1;
  Real y(start = 0, fixed = true);
equation
  der(y) = K*(u[1] + 2*u[2]) - y;
end Mixer;
record Size
  parameter Real a = 1;
  parameter Real b = 1;
end Size;
model Sized
  parameter Size own = Size(a = 2, b = 3);
  Size free;
  parameter Real k = 1;
  output Real y = own.a*free.a*(1 - exp(-k*time));
end Sized;
model Rest
  parameter Real k = 1;
  parameter Real q(fixed = false);
  Real x(start = 1, fixed = true);
  output Real y = x + q;
initial equation
  q = 7*x;
equation
  der(x) = -k*x;
end Rest;
model Early
  parameter Real a = 1;
  output Real y = 1/(a*time);
  Real sum(start = 0, fixed = true);
equation
  der(sum) = y;
end Early;
