model Ball
  parameter Real e = 0.8;
  Real h(start = 1, fixed = true), v(start = 0, fixed = true);
  discrete Real u;
equation
  der(h) = v;
  der(v) = -e*u;
  when sample(0, 0.1) then
    u = h;
  end when;
end Ball;
