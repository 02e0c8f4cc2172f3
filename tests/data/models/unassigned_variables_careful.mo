function careful
  input Real x;
  output Real y = 0;
protected
  Real i = 0;
algorithm
  while i * x < 3 * x loop
    i := i + 1;
    assert(x < 0.125, "x is " + String(3) + " times too large", AssertionLevel.warning);
    assert(x < 7, "never", AssertionLevel.warning);
    y := y + i * x;
  end while;
end careful;
