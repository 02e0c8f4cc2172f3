model Cell
  Real v = ;
end Cell;
