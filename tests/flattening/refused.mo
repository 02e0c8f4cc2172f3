// MLS §7.4: what is not translated yet says so at its place.
package refused
  connector Pin
    Real v;
    flow Real i;
  end Pin;
  model Base
    Pin a;
    Pin b;
  equation
    connect(a, b);
  end Base;
  model Main
    extends Base(break connect(a, b));
  end Main;
end refused;
