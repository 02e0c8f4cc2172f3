// A compressor: the branches give the same variables in another order, and off, k = 1 would divide by
// zero. Nothing is a loop.
model branches_in_order
  Boolean on = time > 1;
  Real k, v, p, q;
equation
  if on then
    v = 1 / (2 + time);
    k = 1.1 + v;
    p = k / (k - 1);
    -q = 2 * p;
  else
    k = 1;
    p = 0;
    v = time;
    q = 1;
  end if;
end branches_in_order;
