// MLS §8.3.4, §4.4.5: a branch chosen by a parameter, a component left out by its condition.
package conditional_equations
  model Part
    Real p = 1;
  end Part;
  model Main
    parameter Boolean on = false;
    parameter Real k = 2;
    Part part if on;
    Real x;
  equation
    if k > 1 then
      x = k;
    else
      x = -k;
    end if;
  end Main;
end conditional_equations;
