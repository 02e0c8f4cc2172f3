model Switch "an if-equation that switches with time and state"
  Real x(start = 0, fixed = true);
  Real y;
equation
  if time < 1 then
    der(x) = 1;
    y = x;
  elseif x > 0.5 then
    der(x) = -x;
    y = 2*x;
  else
    der(x) = 0;
    y = -x;
  end if;
end Switch;
