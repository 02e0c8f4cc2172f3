// A record is assigned as a whole in an algorithm, and given by one of several outputs in an equation.
model records_of_algorithms
  record R
    Real a;
    Real b[2];
  end R;
  function f
    input Real u;
    output R r = R(u, {u, 2*u});
    output Real last = 3*u;
  algorithm
  end f;
  R r;
  R s;
  Real x;
equation
  (s, x) = f(time);
algorithm
  r := f(2*time);
  r.a := r.a + 1;
end records_of_algorithms;
