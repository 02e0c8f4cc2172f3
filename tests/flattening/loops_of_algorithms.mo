// MLS §11.2.2: the range of a loop in an algorithm of a model is that of its parameters, which shape
// the model by that; a loop variable that chooses among components is
// written out; §10.4: `array` with iterators is the array constructor.
package loops_of_algorithms
  model Main
    parameter Integer n = 3;
    Real x[n] = array(i*time for i in 1:n);
    Real s;
    record Part
      Real v;
    end Part;
    Part c[2];
  algorithm
    s := 0;
    for i in 1:n loop
      for j in i:n loop
        s := s + j*x[i];
      end for;
    end for;
  algorithm
    for j in 1:2 loop
      c[j].v := j*time;
      if c[j].v > 1 then
        c[j].v := 1;
      end if;
    end for;
  end Main;
end loops_of_algorithms;
