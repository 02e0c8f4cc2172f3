model Cell
  parameter constant Real v = 1;
end Cell;
