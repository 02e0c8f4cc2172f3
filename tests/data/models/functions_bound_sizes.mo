model Sizes
  partial function Integrand
    input Real u;
    output Real y;
  end Integrand;
  function weighted
    extends Integrand;
    input Real d[n];
    input Integer n;
  algorithm
    y := u*sum(d)/n;
  end weighted;
  function trapezoid
    input Integrand f;
    input Real a;
    input Real b;
    output Real area;
  algorithm
    area := (b - a)*(f(a) + f(b))/2;
  end trapezoid;
  function total
    input Real d[:];
    output Real y;
  algorithm
    y := trapezoid(function weighted(d = d, n = size(d, 1)), 0, 2);
  end total;
  parameter Integer k = integer(total({1, 2, 3}));
  Real v[k] = fill(time, k);
  Real z = total({1, 2, 3 + time});
end Sizes;
