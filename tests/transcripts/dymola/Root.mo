model Root
  Real x(start = 1, fixed = true);
  Real y = sqrt(x - 0.5);
equation
  der(x) = -x;
end Root;
