model Block
  parameter Real limit = 1;
  Real v(start = 0, fixed = true);
  Real s;
  Real a;
  Boolean slides(start = false, fixed = true);
  Boolean begins(start = false, fixed = true);
equation
  begins = not pre(slides) and (s > limit or pre(begins) and s > limit);
  slides = begins and v > 0 or pre(slides) and v > 0;
  a = if not (begins or pre(slides)) then 0 else s - limit;
  a = time - (if not (begins or pre(slides)) then s else limit);
  der(v) = a;
end Block;
