model Ball
  parameter Real e(min = 0, max = 1) = 0.7;
  parameter Real g = 9.81;
  Real h(start = 1, fixed = true);
  Real v(start = 0, fixed = true);
equation
  der(h) = v;
  der(v) = -g;
  assert(g > 0, "no gravity");
  when h <= 0 then
    reinit(v, -e*pre(v));
  end when;
  annotation(experiment(StopTime = 3, Tolerance = 1e-8));
end Ball;