model Slides "slides on y = 0 with the mean of two unequal fields until they turn away at t = 3"
  Real x(start = 0, fixed = true);
  Real y(start = 0.5, fixed = true);
  Real z = (if y > 0 then 4 else 1) "its mean is 4 q + (1 - q)";
  Boolean up = y > 0;
equation
  der(x) = if y > 0 then 1 else 5;
  der(y) = (if y > 0 then -3 else 1) + (if time > 3 then 6 else 0);
end Slides;
