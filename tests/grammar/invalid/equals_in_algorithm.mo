function f
  input Real x;
  output Real y;
algorithm
  y = 2 * x;
end f;
