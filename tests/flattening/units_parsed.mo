// MLS §19.1: unit expressions with products, quotients, exponents and prefixes measure one
// dimension.
model units_parsed
  Real power(unit = "W") = 1;
  Real mechanical(unit = "kg.m2/s3") = power;
  Real electrical(unit = "kV.mA") = power;
  Real quotient(unit = "J/(s.rad)") = power;
  Real wrong(unit = "N.m/s2") = power;
end units_parsed;
