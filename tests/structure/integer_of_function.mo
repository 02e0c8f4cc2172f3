// A function gives an Integer that follows a continuous variable: it is computed with the others.
model integer_of_function
  function phases
    input Real h;
    output Integer n;
  algorithm
    n := 1;
    while n < 3 and h > n loop
      n := n + 1;
    end while;
  end phases;
  Integer n;
  Real h(start = 0, fixed = true), y;
equation
  der(h) = 1 + y;
  n = phases(h);
  y = if n == 2 then 1 else 0;
end integer_of_function;
