model Limited
  parameter Real k = 1;
  parameter Real g[2] = {1, 2};
  parameter Boolean on = true;
  parameter String label = "a";
  Real x(start = 0, fixed = true);
  Real y = g[1] + 10*g[2];
equation
  assert(k < 5, "k too large");
  der(x) = k;
end Limited;
