model MixedLoop "a Boolean loop, and a discrete Real solved with a continuous variable"
  Boolean set = time > 1;
  Boolean reset = time > 2;
  Boolean q(start = false);
  Boolean n(start = true);
  Real y;
  discrete Real u(start = 0);
equation
  q = not (reset or n);
  n = not (set or q);
  y = 2*u + time;
  when q then
    u = 1 - y;
  end when;
end MixedLoop;
