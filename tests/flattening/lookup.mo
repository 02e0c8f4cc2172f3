// MLS §5.3.3, §5.3.4, §13.2, §5.6.1.4: global names, imported names of all forms, and names that are
// looked up where their text stands.
package lookup
  constant Real k = 1;
  package Inner
    constant Real k = 2;
    constant Real q = 3;
    model Part
      parameter Real here = k;
      parameter Real top = .lookup.k;
    end Part;
    package Deep
      constant Real d = q + k;
    end Deep;
  end Inner;
  model Main
    import lookup.Inner.Part;
    import D = lookup.Inner.Deep;
    import lookup.Inner.{q};
    import lookup.Inner.Deep.*;
    Part part(here = k);
    Part other;
    Real x = D.d + q;
    Real y = d;
  end Main;
end lookup;
