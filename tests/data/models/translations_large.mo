model Large
  parameter Real p = 1;
  Real x[1000](each start = 0, each fixed = true);
  Real s = sum(x);
equation
  for i in 1:1000 loop
    der(x[i]) = p - x[i]*i*1e-3;
  end for;
end Large;
