// MLS §6.7: what is computed has a type too.
model types_of_bindings
  type E = enumeration(a, b);
  parameter Real r = 1.5;
  parameter Integer n = r;
  parameter Integer m = 4/2;
  parameter Real s = "text";
  parameter Boolean flag = r + 1;
  parameter Real fine = n;
  parameter E good = E.b;
end types_of_bindings;
