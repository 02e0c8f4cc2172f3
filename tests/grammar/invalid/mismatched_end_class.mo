model Cell
  Real v;
end Stack;
