// Refused, with the place.
package connections
  connector Pin
    Real v;
    flow Real i;
  end Pin;
  model Main
    Pin p;
  equation
    p.i = 0;
  end Main;
end connections;
