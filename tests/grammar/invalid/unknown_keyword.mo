modle Cell
  Real v;
end Cell;
