model branches "names in branches that are not taken, and under conditions"
  parameter Boolean on = false annotation(Evaluate = true);
  MissingType a if on;
  Real x = if on then missingThen else 1;
  Real y;
  Real z[2];
equation
  if on then
    y = missingInEquation;
  else
    y = 1;
  end if;
  for i in 1:2 loop
    z[i] = if i > missingBound then i else 0;
  end for;
initial equation
  if on then
    assert(missingCondition, "no");
  end if;
algorithm
  when false then
    if on then
      reinit(missingState, 0);
    end if;
  end when;
end branches;
