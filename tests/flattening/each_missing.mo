// MLS §7.2.5: a scalar modifier of an array of components needs `each`; libraries forget it.
package each_missing
  model Cell
    parameter Real p = 1;
    Real x = p;
  end Cell;
  model Main
    Cell c[2](p = 3);
    Cell d[2](each p = 3);
    Cell e[2](p = {3, 4});
  end Main;
end each_missing;
