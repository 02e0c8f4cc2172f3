// MLS §10.6.1: a scalar is not the value of an array.
model scalar_for_array
  parameter Real p[3] = 1;
  Real x[2] = fill(1, 2, 2);
end scalar_for_array;
