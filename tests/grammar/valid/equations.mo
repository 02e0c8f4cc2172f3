model M
equation
  x = 1 "why" annotation(a = 1);
  0 = x + y;
  (a, , b) = f(x);
  if a then
    x = 1;
  elseif b then
    x = 2;
    y = 3;
  else
    x = 4;
  end if;
  if a then
  end if;
  for i in 1:n, j loop
    x[i, j] = i;
  end for;
  for i loop
    x[i] = y[i];
  end for;
  when {a, b} then
    reinit(x, 1);
  elsewhen c then
    x = pre(x);
  end when "when";
  connect(a.b[1].c, d);
  assert(x > 0, "positive", level = AssertionLevel.warning);
  Connections.root(a.b);
initial equation
  der(x) = 0;
end M;
