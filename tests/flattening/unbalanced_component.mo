// MLS §4.8: where the model is unbalanced, the classes to blame are named.
package unbalanced_component
  connector Pin
    Real v;
    flow Real i;
  end Pin;
  connector In = input Real;
  connector Out = output Real;
  model Resistor
    Pin p, n;
    parameter Real R = 1;
    Real v;
  equation
    v = p.v - n.v;
    v = R*p.i;
  end Resistor;
  model Source
    Pin p, n;
    In v;
  equation
    v = p.v - n.v;
    p.i + n.i = 0;
  end Source;
  block Constant
    Out y = 1;
  end Constant;
  model Circuit
    Pin outside;
    Resistor a, b;
  protected
    Pin inner_pin;
  equation
    connect(outside, a.p);
    connect(a.n, b.p);
    connect(a.n, inner_pin);
  end Circuit;
  model Main
    Circuit circuit;
    Source source;
    Constant one;
  equation
    connect(circuit.outside, source.p);
    connect(one.y, source.v);
  end Main;
end unbalanced_component;
