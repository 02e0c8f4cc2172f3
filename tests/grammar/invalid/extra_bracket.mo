model Cell
  Real v = 2 * (time + 1));
end Cell;
