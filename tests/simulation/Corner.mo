model Corner "comes to rest in the corner of two surfaces, w keeps moving"
  Real x(start = 1, fixed = true);
  Real y(start = 2, fixed = true);
  Real w(start = 0, fixed = true);
  Real a = if x > 0 then 1 else -1;
  Real b = if y > 0 then 1 else -1;
equation
  der(x) = -a + 0.25*b;
  der(y) = -0.25*a - b;
  der(w) = 2 + 3*a + b;
end Corner;
