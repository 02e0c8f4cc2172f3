model Curve
  parameter Real a = 1;
  input Real i;
  output Real U = log(1 - i/a);
end Curve;
model Growth
  parameter Real a = 1;
  parameter Real x0 = 1;
  Real x(start = x0, fixed = true);
equation
  der(x) = a*x;
  assert(x < 2, "too large");
end Growth;
