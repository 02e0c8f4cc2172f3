// MLS §12.2: inputs are read only, public components are inputs or outputs, there is one
// algorithm, and partial functions are not called.
package function_restrictions
  function assigns
    input Real u;
    output Real y;
  algorithm
    u := 2;
    y := u;
  end assigns;
  function shows
    input Real u;
    Real v;
    output Real y;
  algorithm
    y := u;
  end shows;
  function twice
    input Real u;
    output Real y;
  algorithm
    y := u;
  algorithm
    y := 2*u;
  end twice;
  partial function half
    input Real u;
    output Real y;
  end half;
  function guesses
    input Real u;
    output Real y;
  algorithm
    y := undeclared*u;
  end guesses;
  model Main
    Real a = assigns(1);
    Real b = shows(1);
    Real c = twice(1);
    Real d = half(1);
    Real e = guesses(1);
  end Main;
end function_restrictions;
