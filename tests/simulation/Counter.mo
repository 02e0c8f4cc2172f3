model Counter "a counter with reset, as an algorithm"
  Integer n(start = 0, fixed = true);
  Boolean odd;
  Integer total(start = 0);
algorithm
  when sample(0.25, 0.25) then
    n := pre(n) + 1;
    if n == 4 then
      n := 0;
    end if;
    for i in 1:3 loop
      total := total + i*n;
    end for;
  elsewhen time > 1.9 then
    n := 100;
  end when;
  odd := n == 1 or n == 3;
end Counter;
