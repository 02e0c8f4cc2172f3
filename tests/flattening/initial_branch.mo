// `if initial() then` in an equation section, as libraries of 2001 have it: an initial equation.
model initial_branch
  Real x;
equation
  if initial() then
    x = 3;
  end if;
  der(x) = -x;
end initial_branch;
