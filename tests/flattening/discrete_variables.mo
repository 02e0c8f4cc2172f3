// MLS §4.5: what is declared `discrete` has its values from the when-clauses of its own class.
package discrete_variables
  block B
    discrete Real x(start = 0, fixed = true);
  end B;
  model Main
    discrete Real y = 1.0;
    B b;
  equation
    when sample(0, 1) then
      b.x = 1;
    end when;
  end Main;
end discrete_variables;
