model Tank
  parameter Real k(unit = "1/s") = 1;
  parameter Real h0(unit = "m") = 1;
  parameter Real offset = 0;
  parameter Real idle = 1;
  Real h(start = h0, fixed = true, unit = "m");
  Real q = k*h;
  Real doubled = 2*h + offset;
equation
  der(h) = -k*h;
end Tank;
