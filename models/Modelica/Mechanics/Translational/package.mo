within Modelica.Mechanics;
package Translational "Rods"
  import Modelica.Units.SI;
  extends Modelica.Icons.Package;

  // Where version 2 had them.
  model SlidingMass = Components.Mass;
  model Rod = Components.Rod;
  model Fixed = Components.Fixed;
  model Spring = Components.Spring;
  model Damper = Components.Damper;
  model SpringDamper = Components.SpringDamper;
  annotation(Documentation(info = "<html>
<p>A flange holds the position of the end of a rod and the force that acts on the component there.</p>
</html>"));
end Translational;
