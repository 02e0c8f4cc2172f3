model WhenClauses
  Real x(start = 1);
  discrete Real held;
  Boolean high(start = false);
  Integer count(start = 0);
  Real y;
equation
  der(x) = -x + y;
  high = x > 0.8 or pre(high) and x > 0.4;
  when high then
    held = x;
    count = pre(count) + 1;
  elsewhen sample(0.5, 1) then
    held = 2*x;
    count = pre(count);
  end when;
  y = if high then 0 else held;
end WhenClauses;
