// MLS §4.8.
model unbalanced
  Real x;
  Real y;
equation
  x = 1;
end unbalanced;
