model M
  record Point
    Real x;
    Real y[2];
  end Point;
  parameter Integer n = 2;
  Point filled[n] = fill(Point(time, {1, 2}), n);
  Point joined[n + 1] = cat(1, filled, {Point(3, {4, 5})});
  Point grid[2, 1] = {{filled[1]}, {Point(6, {7, 8})}};
  Point turned[1, 2] = transpose(grid);
  parameter Point given[n] = fill(Point(9, {10, 11}), n);
  function scaled
    input Point p;
    input Real by;
    output Point q;
  algorithm
    q := Point(by * p.x, by * p.y);
  end scaled;
  function total
    input Point p;
    output Real t;
  algorithm
    t := p.x + sum(p.y);
  end total;
  function totals
    input Point p[:];
    output Real t;
  algorithm
    t := sum(total({scaled(p[k], k) for k in 1:size(p, 1)}));
  end totals;
  Real t = totals(filled);
  Point twice[n] = scaled(filled, 2);
  parameter Integer m = 3;
  Real ramp = sum({k * time for k in 1:m});
end M;