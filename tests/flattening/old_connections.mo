// Connections that reach into the components of components, beside others made inside them: the
// connection sets are formed over the whole tree, so that each sum of flows is written once. A
// connector inside and outside of one class (`exa1`) is two sides of it (MLS §9.1.2).
package old_connections
  connector Pin
    Real v;
    flow Real i;
  end Pin;
  model Resistor
    Pin exa1, exa2;
    parameter Real R = 1;
  equation
    exa1.v - exa2.v = R*exa1.i;
    exa1.i + exa2.i = 0;
  end Resistor;
  model Element
    Pin exa1;
    Resistor tp1, tp2;
  equation
    connect(exa1, tp1.exa1);
    connect(tp1.exa2, tp2.exa1);
  end Element;
  model Layer
    parameter Integer n = 3;
    Element c[n];
  equation
    for i in 1:n - 1 loop
      connect(c[i].tp2.exa2, c[i + 1].tp1.exa1);
    end for;
  end Layer;
  model Ground
    Pin p;
  equation
    p.v = 0;
  end Ground;
  model Source
    Pin p;
  equation
    p.v = 1;
  end Source;
  model Main
    Layer layer(n = 2);
    Ground ground;
    Source source;
    Resistor parallel;
  equation
    connect(source.p, layer.c[1].tp1.exa1);
    connect(parallel.exa1, layer.c[1].tp1.exa1);
    connect(parallel.exa2, layer.c[2].tp1.exa1);
    connect(layer.c[2].tp2.exa2, ground.p);
  end Main;
end old_connections;
