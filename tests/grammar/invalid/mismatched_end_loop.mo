model Cell
  Real v[3];
equation
  for i in 1:3 loop
    v[i] = i;
  end if;
end Cell;
