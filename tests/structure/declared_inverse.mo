// `annotation(inverse(…))` (MLS §12.8): the equations of x and y are solved by the functions that are
// declared to solve them, and so is that of v, whose function has its inverse in a part of its range.
// That of z, which stands twice in the call, and that of w, whose function may be inlined, are not; nor
// is that of u, the same function as of v in a loop.
model declared_inverse
  function rate
    input Real dp;
    input Real k;
    output Real m;
  algorithm
    m := if dp >= 0 then k * sqrt(dp) else -k * sqrt(-dp);
    annotation(Inline = false, inverse(dp = drop(m, k = k)));
  end rate;
  function drop
    input Real m;
    input Real k;
    output Real dp;
  algorithm
    dp := (m / k) * abs(m / k);
    annotation(Inline = false, inverse(m = rate(dp = dp, k = k)));
  end drop;
  function open
    input Real dp;
    output Real m;
  algorithm
    m := dp ^ 3;
    annotation(inverse(dp = shut(m)));
  end open;
  function shut
    input Real m;
    output Real dp;
  algorithm
    dp := if m >= 0 then m ^ (1 / 3) else -(-m) ^ (1 / 3);
  end shut;
  function smooth
    input Real dp;
    output Real m;
  algorithm
    m := if abs(dp) < 0.1 then dp * (1 + (0.1 - abs(dp)) ^ 2) else dp;
    annotation(Inline = false, inverse(dp = same(m)));
  end smooth;
  function same
    input Real m;
    output Real dp = m;
  algorithm
  end same;
  parameter Real k = 2;
  Real x, y, z, w, v, u, s;
equation
  3 * rate(x, k) + 1 = time;
  drop(y, k) = time;
  rate(z, z) = 1 + time;
  open(w) = time;
  smooth(v) = time;
  smooth(u) = time - s;
  s = u ^ 2;
end declared_inverse;
