// Strictly MLS §5.3.2 allows constants only: the parameter of a class, not of a component, has the
// value of its declaration.
package parameter_of_record_class
  record K
    parameter Integer W = 2 + n;
    parameter Integer n = 1;
  end K;
  model Main
    Real x[K.W];
  equation
    for k in 1:K.W loop
      x[k] = k*time;
    end for;
  end Main;
end parameter_of_record_class;
