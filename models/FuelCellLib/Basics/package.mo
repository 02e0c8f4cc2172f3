within FuelCellLib;
package Basics "Connectors, transport elements, control volumes and collectors"
  constant Real F(final unit = "C/mol") = 96485 "Faraday constant";
  constant Real area(final unit = "m2") = 1 "area of the cell that a load in Ohm is joined with";
  constant Units.MolarMass massh2o = 0.018 "molar mass of water";
  annotation(Documentation(info = "<html>
<p>A layer is a chain of control volumes, which store and convert, and of transport elements between
them, which let flow. Fluxes, currents included, are positive into a component. The electronic flux
<code>je</code> is a flux of <b>electrons</b> times the Faraday constant, so it runs against the
conventional current; the protonic flux <code>jp</code> is a conventional current.</p>
</html>"));
end Basics;
