model Chain
  parameter Real k = 0.5;
  parameter Real q = 0.2;
  parameter Real a = 1;
  parameter Real s = 1;
  parameter Real b = 0;
  parameter Real c = 0;
  Real x(start = 1, fixed = true);
  Real z(start = 0, fixed = true);
  Real signal = a*z;
  Real second = x;
  Real scaled = s*z + b;
  Real rescaled = s*x + c;
equation
  der(x) = -k*x;
  der(z) = k*x - q*z;
end Chain;
