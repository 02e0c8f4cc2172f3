model Cell
  paramter Real v = 1;
end Cell;
