model Guarded "An assertion in a branch, beside a function that does not become an expression"
  function root
    input Real x;
    output Real y;
  algorithm
    assert(x > 1, "x is too small");
    y := sqrt(x);
  end root;
  function chosen
    input Real x;
    output Real y;
  protected
    Real a[3] = {1, 2, 3};
    Integer i;
  algorithm
    i := integer(x) + 1;
    y := if x > 0.5 then a[min(i, 3)] else 0;
  end chosen;
  Real x(start = 0, fixed = true);
  Real y;
equation
  der(x) = 1;
  y = if x > 2 then root(x) + chosen(x) else 0;
end Guarded;
