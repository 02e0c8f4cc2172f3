// `annotation(inverse(…))` (MLS §12.8): the equation of x is solved by the function that is declared
// to solve it, which is only nearly an inverse here. That of z, which stands twice in the call, and
// that of w, whose function may be inlined, are not.
model declared_inverse
  function rate
    input Real dp;
    input Real k;
    output Real m;
  algorithm
    m := k * (dp + dp ^ 3);
    annotation(Inline = false, inverse(dp = drop(m, k = k)));
  end rate;
  function drop
    input Real m;
    input Real k;
    output Real dp;
  algorithm
    dp := m / k / 2;
    annotation(Inline = false, inverse(m = rate(dp = dp, k = k)));
  end drop;
  function open
    input Real dp;
    output Real m;
  algorithm
    m := dp + dp ^ 3;
    annotation(inverse(dp = shut(m)));
  end open;
  function shut
    input Real m;
    output Real dp;
  algorithm
    dp := m / 2;
  end shut;
  parameter Real k = 2;
  Real x, y, z, w;
equation
  3 * rate(x, k) + 1 = time;
  drop(y, k) = time;
  rate(z, z) = 1 + time;
  open(w) = time;
end declared_inverse;
