model Cell
  Real v, i;
equation
  v = 2 * i
  i = time;
end Cell;
