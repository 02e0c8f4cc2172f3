// MLS §7.2.2, §7.2.7, §5.6, §5.6.1, §5.6.2: bindings of records, modifications of derived classes over those of bases, arrays of
// modifications, `break` of nothing; the description and the experiment (§18.4) of the model itself.
package merged_modifications
  record Point
    Real x = 1, y = 2;
  end Point;
  model Base
    Point p(x = 3);
    parameter Real k[2] = {1, 2};
  end Base;
  model Derived
    extends Base(p(y = 4), k = {5, 6});
  end Derived;
  model Main "the outermost modification counts"
    Derived d(p(x = time));
    Derived whole(p = Point(7, 8));
    Derived many[2](k = {{1, 2}, {3, 4}}, each p(y = 0));
    annotation(experiment(StopTime = 2, Interval = 0.1, Tolerance = 1e-5));
  end Main;
end merged_modifications;
