model M
  parameter Real tau = 1 [s];
end M;
