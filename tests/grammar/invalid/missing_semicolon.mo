model Cell
  Real v
  Real i;
equation
  v = 2 * i;
end Cell;
