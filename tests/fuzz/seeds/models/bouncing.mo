model Bouncing
  parameter Real e = 0.7;
  Real h(start = 1, fixed = true), v(start = 0, fixed = true);
  Boolean flying(start = true, fixed = true);
equation
  der(h) = v;
  der(v) = if flying then -9.81 else 0;
  when h <= 0 then
    reinit(v, -e*pre(v));
    flying = edge(flying) or abs(v) > 1e-3;
  end when;
end Bouncing;
