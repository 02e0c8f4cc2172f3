model Cell
  Real m[2] = {1, 2);
end Cell;
