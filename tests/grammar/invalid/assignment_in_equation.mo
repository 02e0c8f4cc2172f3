model Cell
  Real v;
equation
  v := 2 * time;
end Cell;
