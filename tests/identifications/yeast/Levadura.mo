model Levadura "crecimiento logistico"
  parameter Real r = 0.5;
  parameter Real K = 10;
  Real x(start = 0.5, fixed = true);
  output Real biomasa = x;
equation
  der(x) = r*x*(1 - x/K);
end Levadura;
