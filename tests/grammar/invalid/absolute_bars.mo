model M
  Real x;
equation
  x = |time - 1|;
end M;
