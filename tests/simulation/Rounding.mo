model Rounding "functions that jump"
  Real x = 3*sin(time);
  Real down = floor(x);
  Real up = ceil(x);
  Integer whole = integer(2*time);
  Real saw = mod(time, 0.5);
  Real back = rem(-time, 0.3);
  Real quotient = div(x, 2);
  Real area(start = 0, fixed = true);
equation
  der(area) = saw;
end Rounding;
