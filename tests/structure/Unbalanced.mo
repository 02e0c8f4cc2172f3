model Unbalanced
  Real x;
  Real y;
  Real z;
equation
  x = 1;
  x = time;
end Unbalanced;
