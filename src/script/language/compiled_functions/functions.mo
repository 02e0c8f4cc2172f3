// Functions that scripts call again and again.
package F
  function series
    input Real x;
    input Integer n;
    output Real y = 0;
  algorithm
    for i in 1:n loop
      if mod(i, 3) == 0 then
        y := y - sin(x/i);
      else
        y := y + x/i^2;
      end if;
    end for;
  end series;

  function sorted
    input Real a[:];
    output Real b[size(a, 1)] = a;
  protected
    Real t;
  algorithm
    for i in 1:size(a, 1) loop
      for j in i + 1:size(a, 1) loop
        if b[j] < b[i] then
          t := b[i];
          b[i] := b[j];
          b[j] := t;
        end if;
      end for;
    end for;
  end sorted;

  function collatz
    input Integer n;
    output Integer steps = 0;
  protected
    Integer k = n;
  algorithm
    while k <> 1 loop
      k := if mod(k, 2) == 0 then div(k, 2) else 3*k + 1;
      steps := steps + 1;
    end while;
  end collatz;

  function fibonacci
    input Integer n;
    output Integer f;
  algorithm
    f := if n < 2 then n else fibonacci(n - 1) + fibonacci(n - 2);
  end fibonacci;

  function product
    input Real a[:, :];
    input Real x[size(a, 2)];
    output Real y[size(a, 1)] = a*x;
    output Real n = sqrt(sum(y .^ 2));
  end product;

  function sized
    input Integer n;
    output Real y[n, 2];
  algorithm
    y := [linspace(0, 1, n), ones(n)];
  end sized;

  function isIn
    input Integer x;
    input Integer set[:];
    output Boolean found = false;
  algorithm
    for s in set loop
      found := found or s == x;
    end for;
  end isIn;

  // The products are beyond 2^53, and exact.
  function generator
    input Integer seed;
    output Integer next;
  algorithm
    next := mod(1103515245*seed + 12345, 2147483648);
  end generator;

  // A sign of zero that an Integer does not have.
  function zero
    input Integer n;
    output Real y;
    output Real direction;
  protected
    Integer i = 0*n;
    Integer j = -(n + 3);
    Integer k = div(1, n);
  algorithm
    y := i;
    direction := atan2(i, -1.0) + 10*atan2(j, -1.0) + 100*atan2(k, -1.0);
  end zero;

  function exponents
    input Real x;
    output Real y = x^2 + x^3 + x^(-1) + x^0.5 + exp(-x^2) + log10(x)*tanh(x);
  end exponents;

  function grown
    input Real x;
    output Real y = x*x;
  end grown;

  // The infinite number is not among the outputs.
  function hidden
    input Real x;
    output Real y;
  protected
    Real large = x*x;
  algorithm
    y := if large > 10 then 1/large else 0;
  end hidden;

  function ratio
    input Real x;
    output Real y = 1/x;
  end ratio;

  function root
    input Real x;
    output Real y = sqrt(x);
  end root;

  function checked
    input Real x;
    output Real y = x;
  algorithm
    assert(x > 0, "not above zero: " + String(x));
  end checked;

  function unassigned
    input Real x;
    output Real y;
  algorithm
    if x > 0 then
      y := x;
    end if;
  end unassigned;

  function third
    input Real a[:];
    input Integer i;
    output Real y = a[i];
  end third;

  function warned
    input Real x;
    output Real y = x;
  algorithm
    assert(x > 0, "below zero", AssertionLevel.warning);
  end warned;

  function printing
    input Real x;
    output Real y = x;
  algorithm
    Modelica.Utilities.Streams.print("printed");
  end printing;
end F;
