// Outer variables are one variable with their inner one: whichever class has the equation
// determines it for all, in old libraries also from below (MLS §5.4).
package old_outer_variables
  model Collector
    outer Real Eoc, T;
  equation
    Eoc = 1.2 - 0.9e-3*(T - 298);
  end Collector;
  model Layer
    outer Real Eoc;
    Real v;
  equation
    v = Eoc - 0.1;
  end Layer;
  model Main
    inner Real Eoc;
    inner parameter Real T = 340;
    Layer layer[2];
    Collector collector;
  end Main;
end old_outer_variables;
