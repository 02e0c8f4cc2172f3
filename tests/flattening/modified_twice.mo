// MLS §7.2.4: one modification gives one value to an element.
package modified_twice
  model A
    Real x(start = 1) = 1;
  end A;
  model Main
    A a(x(start = 2), x(min = 0));
    A b(x(start = 2), x(start = 3));
  end Main;
end modified_twice;
