// MLS §5.3, §4.9.5: constants of packages, enumeration literals, imports.
package constants_and_enumerations
  package Data
    constant Real g = 9.81;
    constant Real table[2] = {g, 2*g};
    type Kind = enumeration(slow, fast);
  end Data;
  model Main
    import D = constants_and_enumerations.Data;
    import constants_and_enumerations.Data.g;
    parameter D.Kind kind = D.Kind.fast;
    Real x = g + D.table[2];
    Real y = if kind == Data.Kind.fast then 2 else 1;
  end Main;
end constants_and_enumerations;
