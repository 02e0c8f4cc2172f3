// MLS §4.9.5, §6.7, §10.6, §3.7.1: enumerations have only values of types with the same literals;
// arithmetic and the functions of numbers take neither them nor Booleans.
model types_of_enumerations
  type E = enumeration(one, two);
  type F = enumeration(one, three);
  parameter E other = F.one;
  parameter E number = 1;
  parameter Integer i = E.two;
  parameter E right = E.two;
  Real x = 2.0*terminal();
  Real y = sign(true) + abs(-2);
end types_of_enumerations;
