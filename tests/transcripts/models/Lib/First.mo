within Lib;
model First
  parameter Real p = gain;
  Real x;
equation
  x = p*time;
end First;
