model Cell
  Real v;
equation
  if time > 1
    v = 1;
  else
    v = 2;
  end if;
end Cell;
