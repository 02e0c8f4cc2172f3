// MLS ch. 19, §3.7: units of sums, relations, bindings, equations and assignments; only dimensions
// are compared, and only where all units are written.
package units
  type Length = Real(final quantity = "Length", final unit = "m");
  type Force = Real(final unit = "N");
  model Main
    parameter Length s0 = 1;
    parameter Real k = 2;
    parameter Force c(displayUnit = "kN") = 3;
    Length s(start = 0.1), fits, doubled;
    Real v(unit = "km/h");
    Real energy(unit = "J") = c*s + 0.5*k*v^2;
    Real root(unit = "m") = sqrt(s*s0) + k;
    Real area(unit = "m2") = s;
    Real none = s + v;
    Real assigned(unit = "W");
  equation
    der(s) = v;
    v = if time > 1 then fits/time else der(fits);
    fits = max(s, s0) + 1e-3;
    doubled = der(v);
  algorithm
    assigned := c*v;
    assigned := if s > c then c*v else c*s;
    assigned := c*s;
  end Main;
end units;
