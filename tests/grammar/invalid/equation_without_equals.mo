model Cell
  Real v;
equation
  2 * v;
end Cell;
