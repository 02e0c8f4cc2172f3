// MLS §5.4, §7.3, §9: what is not translated yet says so, each at its place.
package refused
  model A
    replaceable Real x = 1;
  end A;
  model WithOuter
    outer Real t;
  end WithOuter;
  connector Pin
    Real v;
    flow Real i;
  end Pin;
  model Main
    WithOuter w;
    Pin p;
    inner Real t = 1;
  end Main;
end refused;
