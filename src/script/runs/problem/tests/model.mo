model Tank
  parameter Real k(unit = "1/s") = 1;
  parameter Real area = 1;
  parameter Real gain = 1;
  input Real u;
  Real h(start = 1, fixed = true);
  output Real q;
  output Real p;
equation
  area*der(h) = u - k*h;
  q = k*h;
  p = gain*h;
end Tank;
model Free
  extends Tank(u = 0);
end Free;
