model M
  Real x;
equation
  x = 3,5*time;
end M;
