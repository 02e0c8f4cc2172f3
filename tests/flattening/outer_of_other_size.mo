// MLS §5.4: an outer component has the sizes of its inner one.
package outer_of_other_size
  model A
    outer Real p[3];
    Real x = p[1];
  end A;
  model Main
    inner Real p[2] = {1, 2};
    A a;
  end Main;
end outer_of_other_size;
