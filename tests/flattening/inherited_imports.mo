// MLS §5.3.4: imported names are not inherited.
package inherited_imports
  package P
    constant Real a = 1;
  end P;
  model Base
    import inherited_imports.P.a;
    Real y = a;
  end Base;
  model Main
    extends Base;
    Real z = a;
  end Main;
end inherited_imports;
