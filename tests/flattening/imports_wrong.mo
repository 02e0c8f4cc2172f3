// MLS §13.2: imports lead to packages, each name is imported once; §5.3.4: they are not inherited.
package imports_wrong
  package P
    constant Real a = 1;
  end P;
  model NoPackage
    Real x;
  end NoPackage;
  model Base
    import imports_wrong.P.a;
    Real y = a;
  end Base;
  model Main
    import imports_wrong.NoPackage.x;
    import a = imports_wrong.P.a;
    import imports_wrong.P.a;
    Real z = x;
  end Main;
end imports_wrong;
