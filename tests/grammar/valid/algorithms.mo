function f
  input Real x;
  output Real y;
algorithm
  y := 1 "why" annotation(a = 1);
  a.b[1].c := {1, 2};
  (a, , b[2]) := f(x);
  (c) := f(x);
  print("text");
  if a then
    y := 1;
  elseif b then
    y := 2;
  else
    return;
  end if;
  for i in 1:3 loop
    if i > 2 then
      break;
    end if;
  end for;
  while y < 3 loop
    y := y + 1;
  end while;
  when a then
    y := 1;
  elsewhen b then
    y := 2;
  end when;
initial algorithm
  y := 0;
end f;
