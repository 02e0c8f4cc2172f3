// MLS §4.1, §5.3.2: a protected function is not called through a component; one without a use as
// a subscript has no range (§11.2.2.1).
package protected_function
  model A
  protected
    function f
      input Real x;
      output Real y = 2*x;
    algorithm
    end f;
  end A;
  model Main
    A a;
    Real x = a.f(23.0);
    Real y[2];
  equation
    for i loop
      y[1] = i;
    end for;
    y[2] = 1;
  end Main;
end protected_function;
