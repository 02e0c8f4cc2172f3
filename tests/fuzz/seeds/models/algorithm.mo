model Algorithm
  Real x, y; discrete Real z(start = 0); Integer k(start = 0);
  type Mode = enumeration(off, on);
  Mode mode = if time > 0.5 then Mode.on else Mode.off;
initial algorithm
  z := 1;
algorithm
  x := 0;
  while x < 2 loop x := x + 1; if x > 1 then break; end if; end while;
  when sample(0, 0.25) then z := pre(z) + 1; k := pre(k) + integer(z); end when;
equation
  y^3 + y = x + noEvent(if mode == Mode.on then z else -z);
  assert(y < 1000, "y is too large", AssertionLevel.warning);
end Algorithm;
