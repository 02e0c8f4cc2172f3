// MLS §5.4: an outer component has the elements of its own class, whatever the inner one has.
package outer_of_lesser_class
  record R
    Real i;
  end R;
  record RI
    extends R;
    Real a;
  end RI;
  model A
    outer R T0;
    Real known = T0.i;
    Real unknown = T0.a;
  end A;
  model Main
    inner RI T0(i = 10, a = 11);
    A a;
  end Main;
end outer_of_lesser_class;
