// MLS §5.3.1: of enclosing classes only constants are visible, and they end the search.
package enclosing_variable
  constant Real k = 1;
  model Outer
    parameter Real k = 2;
    model Inner
      Real x = k;
    end Inner;
    Inner inside;
  end Outer;
  model Main
    Outer outside;
  end Main;
end enclosing_variable;
