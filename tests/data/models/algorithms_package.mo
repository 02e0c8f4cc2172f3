package L
  model Units
    Real x(start = 0.25, fixed = true);
    Real rest;
    Real n;
  equation
    der(x) = 3;
  algorithm
    rest := x;
    n := 0;
    while rest > 1 loop
      rest := rest - 1;
      n := n + 1;
    end while;
  end Units;
  model Root
    Real y;
    Real u = 1 + time;
  protected
    Real old;
  algorithm
    y := u;
    old := 0;
    while abs(y - old) > 1e-12 loop
      old := y;
      y := (old + u/old)/2;
    end while;
  end Root;
  model Sampled
    discrete Real s[4](each start = 0, each fixed = true);
    Integer k(start = 0, fixed = true);
  algorithm
    when sample(0.1, 0.25) then
      k := pre(k) + 1;
      for i in 1:k loop
        s[i] := s[i] + i;
        if s[i] > 5.5 then
          break;
        end if;
      end for;
    end when;
  end Sampled;
  model Parts
    Real c[2];
    Real z;
  algorithm
    for j in 1:2 loop
      c[j] := time*j;
      while c[j] > 0.3 loop
        c[j] := c[j] - 0.3;
      end while;
    end for;
    z := c[1] + c[2];
  end Parts;
  model Endless
    Real y;
  algorithm
    y := time + 1;
    while y > 0 loop
      y := y + 1;
    end while;
  end Endless;
  model Asserts
    Real y;
  algorithm
    y := time;
    while y > 0.1 loop
      assert(y < 0.7, "y is too large");
      y := y - 1;
    end while;
  end Asserts;
  model Wanders
    Integer n;
    Real x = time;
  algorithm
    n := 0;
    while n < x loop
      n := n + 1;
    end while;
  end Wanders;
end L;