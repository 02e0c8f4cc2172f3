model Loops
  Real x(start = 1);
  Real y;
  Real z;
  Real w;
equation
  x^2 + y^2 = 1 + time;
  x = exp(y) - 1;
  z + w*x = 3;
  z - w = if x > 0.5 then 1 else 2;
end Loops;
