// The first value of `pre(u)` is that of the input alone: u = y, but y starts with true (MLS §8.6).
model pre_of_input
  Boolean y(start = false), u, w;
initial equation
  y = true;
  pre(u) = false;
  pre(w) = false;
equation
  when time >= 1 then
    y = not pre(y);
  end when;
  u = y;
  w = edge(u) or pre(w) and u;
end pre_of_input;
