model Ball "a ball whose impacts accumulate, on a table that falls away at t = 5"
  parameter Real e = 0.5;
  Real h(start = 1, fixed = true);
  Real v(start = 0, fixed = true);
  Real table = if time > 5 then -10*(time - 5)^2 else 0;
  Integer impacts(start = 0, fixed = true);
equation
  der(h) = v;
  der(v) = -9.81;
  when h <= table then
    reinit(v, -e*pre(v));
    impacts = pre(impacts) + 1;
  end when;
end Ball;
