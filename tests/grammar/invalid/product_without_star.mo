model M
  Real x;
equation
  x = 2time;
end M;
