model SampledController
  parameter Real Ts = 0.1;
  parameter Real k = 2;
  Real x(start = 1, fixed = true);
  discrete Real u(start = 0, fixed = true);
  Integer n(start = 0, fixed = true);
equation
  der(x) = -x + u;
  when sample(0, Ts) then
    u = -k*x;
    n = pre(n) + 1;
  end when;
end SampledController;
