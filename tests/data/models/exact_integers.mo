package ExactIntegers
  function next "The random numbers of ANSI C"
    input Integer seed;
    output Integer random;
  protected
    Integer factor = 1103515245;
  algorithm
    random := mod(factor*seed + 12345, 2147483648);
  end next;

  function afterSteps
    input Integer seed;
    input Integer n;
    output Integer random = seed;
  protected
    Integer left = n;
  algorithm
    while left > 0 loop
      random := next(random);
      left := left - 1;
    end while;
  end afterSteps;

  function fibonacci
    input Integer n;
    output Integer number = 0;
  protected
    Integer after = 1, before, left = n;
  algorithm
    while left > 0 loop
      before := number;
      number := after;
      after := before + after;
      left := left - 1;
    end while;
  end fibonacci;

  function ofAll "The product of 1, 2, …, n"
    input Integer n;
    output Integer value = product(i for i in 1:n);
  algorithm
  end ofAll;

  model Exact "A product of 2147483648 and 4194303 is 9007197107257344"
    Integer step(start = 0, fixed = true);
    Integer small = next(step);
    Integer sum = fibonacci(70 + step);
    Integer number = (2147483648 + step)*4194303;
  equation
    when sample(0.1, 0.1) then
      step = pre(step) + 1;
    end when;
  end Exact;

  model Inlined
    Integer step(start = 2000000000, fixed = true);
    Integer random = next(step);
  equation
    when sample(0.1, 0.1) then
      step = pre(step) + 1;
    end when;
  end Inlined;

  model Compiled
    Integer step(start = 3, fixed = true);
    Integer random = afterSteps(42, step);
  equation
    when sample(0.1, 0.1) then
      step = pre(step) + 1;
    end when;
  end Compiled;

  model Sum
    Integer step(start = 0, fixed = true);
    Integer number = fibonacci(78 + step);
  equation
    when sample(0.1, 0.1) then
      step = pre(step) + 1;
    end when;
  end Sum;

  model Matrix
    Integer step(start = 2147483648, fixed = true);
    Integer number[2, 2] = {{step, 1}, {1, step}}^2;
  equation
    when sample(0.1, 0.1) then
      step = pre(step) + 1;
    end when;
  end Matrix;

  model Equation
    Integer step(start = 2147483648, fixed = true);
    Integer number = step*(step + 1);
  equation
    when sample(0.1, 0.1) then
      step = pre(step) + 1;
    end when;
  end Equation;

  model OuterProduct
    Integer step(start = 1, fixed = true);
    Integer number[2, 2] = outerProduct({100000000, 3}, {step, 1});
  equation
    when sample(0.1, 0.1) then
      step = 100000000;
    end when;
  end OuterProduct;

  model Cross
    Integer step(start = 1, fixed = true);
    Integer number[3] = cross({1, 100000000, 200000000}, {1, step, step});
  equation
    when sample(0.1, 0.1) then
      step = 100000000;
    end when;
  end Cross;

  model PartialSum "The product is 9007199254740991, of which a part is 9007199254740992"
    Integer step(start = 1, fixed = true);
    Integer number = {1, 1, -1}*{step, 1, 1};
  equation
    when sample(0.1, 0.1) then
      step = 9007199254740991;
    end when;
  end PartialSum;

  model SumOfArrays
    Integer step(start = 1, fixed = true);
    Integer number[2] = sum({step, i} for i in 1:2);
  equation
    when sample(0.1, 0.1) then
      step = 9007199254740991;
    end when;
  end SumOfArrays;
end ExactIntegers;
