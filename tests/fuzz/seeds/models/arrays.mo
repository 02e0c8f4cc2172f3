model Arrays
  parameter Integer n = 3;
  record Point Real x; Real y; end Point;
  function norm input Real v[:]; output Real y = 0; algorithm
    for i in 1:size(v, 1) loop y := y + v[i]^2; end for;
    y := sqrt(y);
  end norm;
  function total input Point p; output Real y; algorithm y := p.x + p.y; end total;
  Real x[n](each start = 1, each fixed = true), y, A[2, 2] = [1, time; 0, 1];
  Point p(x = time, y = 1);
equation
  for i in 1:n loop der(x[i]) = -i*x[i]; end for;
  y = norm(x) + total(p) + sum(A*{1, 2});
end Arrays;
