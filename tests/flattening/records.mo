// MLS §4.6, §12.6: records take part in equations component by component.
package records
  record Point
    Real x;
    Real y;
  end Point;
  function shift
    input Point p;
    input Real d;
    output Point q;
  algorithm
    q.x := p.x + d;
    q.y := p.y;
  end shift;
  model Main
    parameter Point o = Point(1, 2);
    Point a;
    Point b = shift(a, 3);
  equation
    a = o;
  end Main;
end records;
