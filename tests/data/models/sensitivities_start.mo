model M
  function interpreted
    input Integer s[:];
    input Real a;
    output Real y;
  protected
    Integer n = max(s .* s);
    Real d[n] = fill(a^2, n);
  algorithm
    y := sum(d);
  end interpreted;
  impure function compiled
    input Real a;
    output Real y;
  protected
    Integer i = 0;
  algorithm
    while i < 2 loop
      i := i + 1;
      y := exp(a)*i;
    end while;
  end compiled;
  parameter Real a = 2;
  parameter Integer s[2](each fixed = false);
  parameter Real k[2](each fixed = false);
  Real x(start = 1, fixed = true);
initial equation
  s = {integer(time) + 2, 1};
  k = {interpreted(s, a), compiled(a)};
equation
  der(x) = -0.1*k[1]*x + k[2];
end M;
