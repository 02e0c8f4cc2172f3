model Branches
  function f
    input Real a;
    input Real b;
    output Real y;
  algorithm
    y := a + b;
    while y > 1 loop
      y := y - 1;
    end while;
  end f;
  function g
    input Real a;
    input Real b;
    output Real y;
  algorithm
    y := a - b;
    while y < 0 loop
      y := y + 1;
    end while;
  end g;
  Real x(start = 0, fixed = true);
  Real u;
  Real v;
  Real w;
equation
  der(x) = 1 + 0*(u + v + w);
  u = if x > 0.5 then f(2*sin(x), x) else 0;
  v = if x > 0.2 then 2*sin(x)*u else 1;
  w = if x > 0.5 then g(2*sin(x), x) + v else 0;
end Branches;
