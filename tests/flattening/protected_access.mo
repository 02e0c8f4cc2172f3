// MLS §4.1: protected components are not visible from outside, and are from inside and to heirs.
package protected_access
  model A
    Real x = hidden;
  protected
    Real hidden = 1;
  end A;
  model Heir
    extends A;
    Real y = hidden;
  end Heir;
  model Main
    A a;
    Heir heir;
    Real y = a.x;
    Real z = a.hidden;
  end Main;
end protected_access;
