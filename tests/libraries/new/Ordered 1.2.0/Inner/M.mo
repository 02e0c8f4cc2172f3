within Ordered.Inner;
model M
  parameter Real p = 3;
  Real x = p*time;
end M;
