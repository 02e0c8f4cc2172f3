// MLS §6.7: a value of the wrong type.
model type_mismatch
  parameter Integer n = 1.5;
  parameter Real v[2] = {1, 2, 3};
end type_mismatch;
