// MLS §8.3.5.1, §8.3.5.2, §8.6, §3.7.3, §16.5.1: when-clauses with several branches, initial equations, events.
model when_clauses
  Real x(start = 1, fixed = true);
  discrete Real held(start = 0);
  Integer n(start = 0, fixed = true);
  Boolean up = x > 0.5;
initial equation
  held = 2*x;
equation
  der(x) = if noEvent(x > 0.2) then -x else 0;
  when {x < 0.5, sample(0, 1)} then
    held = pre(held) + 1;
  elsewhen not up then
    held = x;
  end when;
  when edge(up) or change(n) then
    n = pre(n) + 1;
    reinit(x, 1);
  end when;
end when_clauses;
