model Decay
  parameter Real k = 1;
  output Real x(start = 1, fixed = true);
equation
  der(x) = -k*x;
end Decay;
model Ball
  parameter Real e = 0.7;
  Real h(start = 1, fixed = true), v(start = 0, fixed = true);
equation
  der(h) = v;
  der(v) = -9.81;
  when h <= 0 then
    reinit(v, -e*pre(v));
  end when;
end Ball;
model Limited
  Real x(start = 0, fixed = true);
  output Boolean full = x >= 1;
equation
  der(x) = if full then 0 else 1;
end Limited;
model Stair
  output Integer n(start = 1, fixed = true);
equation
  when sample(1, 1) then
    n = pre(n) + 1;
  end when;
  when n == 4 then
    terminate("done");
  end when;
end Stair;
model Driven
  input Real u(start = 1);
  input Integer i(start = 2);
  input Boolean b;
  output Real y = 2*x + 3*u;
  output Integer j = i + 1;
  output Boolean c = not b;
  output Boolean high = u > 2;
  Real x(start = 0, fixed = true);
equation
  der(x) = u - x;
end Driven;
model Loop
  Real x(start = 1, fixed = true);
  output Real z(start = 1);
equation
  der(x) = -z;
  z + 0.1*z^3 + sin(z) = x;
end Loop;
model Named
  parameter String label = "two words";
  Real x(start = 1, fixed = true);
equation
  der(x) = -x;
end Named;
model Late
  Real x(start = 1, fixed = true);
  input Real u;
  output Real y = delay(u, 0.25);
equation
  der(x) = -delay(x, 1);
end Late;
model Pipe
  Real s(start = 0, fixed = true) "How far the content has moved";
  output Real w, z;
equation
  der(s) = 0.5 + 0.25*sin(time);
  (, w) = spatialDistribution(exp(-s), 0, s, true, {0, 1}, {1, exp(1)});
  z = delay(sin(time), 0.5 + 0.1*time, 2);
end Pipe;
model Fast
  input Real u;
  output Real y = der(u);
end Fast;
model Bound
  parameter Real a = 1;
  parameter Real b = 2*a;
  final parameter Real c = b + 1;
  parameter Real d = c;
  parameter Real e(fixed = false);
  Real x(start = b, fixed = true);
  Real z(start = 4, fixed = true);
initial equation
  e = 3*a;
equation
  der(x) = -d*x;
  der(z) = e;
end Bound;
model Begun
  parameter Real a = 2;
  parameter Real x0 = 3;
  Real x(start = x0*a, fixed = true);
  Real z(start = 1, fixed = true);
  Real w;
  output Real y = a*x;
initial equation
  w^3 + w = a;
equation
  der(x) = -a*x;
  der(z) = x;
  der(w) = -w;
end Begun;
model Clocked
  output Real y = hold(n);
  discrete Real n(start = 0);
equation
  when Clock(1, 4) then
    n = previous(n) + interval(n);
  end when;
end Clocked;
model Triggered
  Real x(start = 0, fixed = true);
  output Integer k(start = 0, fixed = true);
  discrete Integer n(start = 0);
equation
  der(x) = 1;
  when Clock(sin(3*x) > 0.5) then
    n = previous(n) + 1;
  end when;
  k = hold(n);
end Triggered;
model Vector
  input Real u[3](start = {1, 2, 3});
  input Real v[2](each start = 0.5);
  output Real y = u[1] + 10*u[2] + 100*u[3] + v[1] - v[2];
  Real x(start = 0, fixed = true);
equation
  der(x) = u[2] - v[1];
end Vector;
connector Inlet
  input Real rate(start = 2);
  output Real level;
end Inlet;
model Tank
  Inlet inlet;
  Real v(start = 0, fixed = true);
equation
  der(v) = inlet.rate;
  inlet.level = 3*v;
end Tank;
model Stateless
  output Real z(start = 1);
equation
  z + 0.1*z^3 = 1 + time;
end Stateless;
connector Properties
  Real T(start = 3), c[2];
end Properties;
connector Port
  input Real rate(start = 2);
  input Properties forward;
  output Properties backward if true;
end Port;
function scaled
  input Real x;
  output Real y;
algorithm
  y := 2*x;
end scaled;
model Exchanger
  Port port;
  Real v(start = 1, fixed = true);
equation
  // The sizes of both sides follow from operators and a function.
  der(v)/2 = scaled(port.forward.T)*port.rate;
  port.backward.T = v + port.forward.c[1];
  port.backward.c = {v, port.forward.c[2]};
end Exchanger;
model Chain
  parameter Real a = 1;
  final parameter Real b = 2*a;
  parameter Real unused = 4;
  input Real u;
  output Real z(start = 1);
  output Real y = x + a*time;
  Real x(start = 1, fixed = true);
equation
  der(x) = -b*x + a*sin(time) + u;
  z + 0.1*z^3 + sin(z) = b*x + time;
end Chain;
model Smooth
  parameter Real a = 1;
  input Real u;
  output Real y = x + a*time;
  Real x(start = 1, fixed = true);
equation
  der(x) = -2*a*x + u;
end Smooth;
model Percent
  Real x(start = 1, fixed = true);
equation
  der(x) = -1;
  assert(x > 0.5, "only 50 % are left: %s", AssertionLevel.warning);
end Percent;
