// MLS §3.7.4.3, §9.4.1: `cardinality` counts connections, and the operators of the graph stand where
// the structure is fixed; §4.8.5: a model is balanced with what its connectors ask for.
package graphs_of_connections
  connector Pin
    Real v;
    flow Real i;
  end Pin;
  model Part
    Pin p;
    Boolean connected = cardinality(p) > 0;
  equation
    if cardinality(p) == 0 then
      p.v = 0;
    else
      p.v = 1 + 2*p.i;
    end if;
  end Part;
  model Main
    Part a, b, c;
  equation
    connect(a.p, b.p);
  end Main;
end graphs_of_connections;
