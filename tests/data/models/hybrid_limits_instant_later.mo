model Later
  Real y(start = 0, fixed = true);
  Real z;
  Integer n(start = 0, fixed = true);
  Integer m(start = 0, fixed = true);
equation
  der(y) = 2;
  z = if time > 0.5 then (y - 1)/(time - 0.5) else 5;
  when sample(0, 0.25) then
    n = pre(n) + 1;
  end when;
  when time > 0.5 then
    m = pre(m) + 1;
  end when;
end Later;
