// Independent errors are reported together, each with a suggestion.
model unknown_names
  parameter Real gain = 1;
  Real x;
  Real y;
equation
  x = gian*time;
  y = x + voltge;
end unknown_names;
