// MLS §10, §8.3.2: sizes from parameters declared later, loops, arrays of components.
package arrays_and_loops
  model Cell
    parameter Real c = 1;
    Real t(start = 0);
  end Cell;
  model Main
    Real x[n];
    parameter Integer n = 3;
    parameter Real v[:] = {1, 2, 3};
    Cell cell[n](c = v, each t(start = 5));
  equation
    for i in 1:n loop
      x[i] = cell[i].t*v[i];
      der(cell[i].t) = sum(cell.c) - x[i];
    end for;
  end Main;
end arrays_and_loops;
