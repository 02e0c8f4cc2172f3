package argument_types "values of another type than what they are given to"
  type Phase = enumeration(liquid, vapour);
  type Flow = enumeration(laminar, turbulent);

  record Point
    Real x;
    Integer count;
  end Point;

  record Segment
    Real x;
    Integer count;
    Real length;
  end Segment;

  function scaled
    input Real u;
    input Integer times = 2;
    output Real y = u*times;
  end scaled;

  function chosen
    input Phase phase;
    input Boolean on = true;
    output Integer n;
  algorithm
    n := if on then Integer(phase) else 0;
  end chosen;

  function weight
    input Point p;
    output Real w = p.x*p.count;
    output Real rest = 0.5;
  end weight;

  function halved
    input Integer n;
    output Integer m = n/2;
  protected
    Integer k = 2^2;
    Integer A[2, 2] = {{1, 2}, {3, 4}};
    Integer B[2, 2] = A^2;
  algorithm
    m := n/2;
    k := div(n, 2) + size(A, 1) + sum(B);
    for i in 1:k loop
      m := m + i;
    end for;
  end halved;

  model Calls
    Real a = scaled(true);
    Real b = scaled(1, times = 2.5);
    Real c = scaled({1, 2, 3})*{1, 1, 1} "a call for each element";
    Integer d = chosen(Flow.laminar);
    Integer e = chosen(Phase.liquid, on = 1);
    Real f = weight(Point(x = true, count = 1.5));
    Point p(x = 1, count = 2);
    Segment s(x = 1, count = 2, length = 3);
    Real g = weight(s);
    Real h = weight(3);
    Real i = scaled(1, 2, times = 3) + scaled(u = 1, u = 2);
    Point q = Point(1, count = 2, x = 3);
  equation
    p = s;
  end Calls;

  model Values
    Integer n(start = 1.5, fixed = true);
    Integer k(start = 1, fixed = 0);
    Real x[3] = {1, 2, 3};
    Real y = if time > 0.5 then 1 else true;
    Real z = min(1, true) + max({1, 2});
    Real w = x[1.0] + x[n];
    Real r;
    Integer m;
  equation
    when time > 0.5 then
      n = pre(n) + 0.5;
      k = pre(k) + 1;
    end when;
  algorithm
    r := true;
    (m, r) := weight(Point(1, 2));
  end Values;
end argument_types;
