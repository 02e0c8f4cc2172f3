model Cell
  Real m[2, 2] = [1, 2; 3, 4;
  Real i = 3;
end Cell;
