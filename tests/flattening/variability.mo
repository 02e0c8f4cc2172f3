// MLS §3.8: a value may not change more often than what it is given to.
model variability
  parameter Real p = 2;
  Real x = time;
  constant Real c = p;
  parameter Real q = x + 1;
  parameter Real r = time;
  parameter Integer n = size({x, x}, 1);
end variability;
