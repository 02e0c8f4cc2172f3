model Loops
  parameter Real a[3] = {2, 3, 4};
  Real x[3](each start = 1, each fixed = true);
  Real u[3];
  Real v[3];
  discrete Real k(start = 1, fixed = true);
equation
  for i in 1:3 loop
    der(x[i]) = u[i] - k*x[i];
    a[i]*u[i] + v[i] = x[i];
    u[i] - a[i]*v[i] = k;
  end for;
  when time > 0.5 then
    k = pre(k) + 1;
  end when;
end Loops;
