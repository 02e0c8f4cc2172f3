model Cell
  Real v = sin(2 * (time + 1);
  Real i = 3;
end Cell;
