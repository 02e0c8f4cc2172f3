// MLS §4.4, §8.3: variables, parameters, bindings and equations.
model parameters_and_equations "decay"
  parameter Real k(unit = "1/s", min = 0) = 2 "rate";
  Real x(start = 1, fixed = true);
  Real y = 2*x "doubled";
equation
  der(x) = -k*x;
end parameters_and_equations;
