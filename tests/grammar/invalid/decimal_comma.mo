model M
  parameter Real k = 0,5;
end M;
