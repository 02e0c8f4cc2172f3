model Cell
  Real v;
equation
  v = sin(time)
end Cell;
