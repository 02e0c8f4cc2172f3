model M
  parameter Real tau = 5 s;
end M;
