package Small
  model A
    Real x(start = 1, fixed = true);
  equation
    der(x) = -x;
  end A;
end Small;
