model Cell
  Real v;
equation
  v = 1;
