model Friction "a block on a table that shakes, dry friction as a relay"
  parameter Real mu = 1;
  Real v(start = 0, fixed = true);
  Real s(start = 0, fixed = true);
  Real f = mu*(if v > 0 then 1 else -1);
equation
  der(s) = v;
  der(v) = 2*sin(time) - f;
end Friction;
