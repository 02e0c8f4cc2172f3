model Tumor
  parameter Real a(min = 0.2, max = 1) = 0.5;
  parameter Real b(min = 0.1, max = 0.6) = 0.3;
  Real V(start = 1, fixed = true);
  Real w(start = a, fixed = true) "Wachstumsrate";
  output Real Volumen = V;
equation
  der(V) = w*V;
  der(w) = -b*w;
end Tumor;
