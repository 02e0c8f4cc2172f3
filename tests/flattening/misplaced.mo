// MLS §8.3.5.2, §11.2.4, §11.2.5, §8.3.7, §3.6.7, §12.4: when-clauses are not nested, `break` stands in loops, `return` in
// functions; asserts and calls have the arguments of their functions.
model misplaced
  Real x = time;
  Real n(start = 0);
  function f
    input Real a;
    output Real b = a;
  algorithm
  end f;
  Real y = f(1, 2);
equation
  when x > 1 then
    when x > 2 then
      n = 1;
    end when;
  end when;
  assert(x, "a condition is Boolean");
algorithm
  break;
  return;
end misplaced;
