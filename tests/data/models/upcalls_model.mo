
model Upcalls
  function root
    input Real x;
    output Real y;
  algorithm
    y := 1 + x*x;
    while abs(y*y - 2 - x*x) > 1e-10*(2 + x*x) loop
      y := 0.5*(y + (2 + x*x)/y);
    end while;
  end root;
  parameter Integer n = 12;
  Real x(start = 1, fixed = true);
  Real w(start = 0, fixed = true);
  Real v[n];
equation
  for i in 1:n loop
    (n + i)*v[i] + sum(sin(i*j + x)*v[j] for j in 1:n) = i*w;
  end for;
  der(x) = w;
  der(w) = if x > 0.9 then -root(w)*x else -root(x)*x + 0.01*v[3];
  annotation(experiment(StopTime = 40, Tolerance = 1e-9));
end Upcalls;
