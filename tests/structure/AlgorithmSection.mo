model AlgorithmSection
  parameter Real k(fixed = false, start = 1);
  Real x(start = 1, fixed = true);
  Real y;
  Integer n(start = 0);
  Boolean up;
initial equation
  der(x) = -2;
equation
  der(x) = -k*x + delay(y, 0.5);
algorithm
  up := x > 0.5;
  y := 0;
  for i in 1:2 loop
    y := y + i*x;
  end for;
  if up then
    y := y - floor(3*x);
  end if;
  when {initial(), not up} then
    n := pre(n) + 1;
  end when;
end AlgorithmSection;
