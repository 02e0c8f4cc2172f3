within Modelica.Mechanics;
package Rotational "Shafts"
  import Modelica.Units.SI;
  extends Modelica.Icons.Package;

  // Where version 2 had them.
  model Inertia = Components.Inertia;
  model Fixed = Components.Fixed;
  model IdealGear = Components.IdealGear;
  model Spring = Components.Spring;
  model Damper = Components.Damper;
  model SpringDamper = Components.SpringDamper;
  model ElastoBacklash = Components.ElastoBacklash;
  annotation(Documentation(info = "<html>
<p>A flange holds the angle of a shaft and the torque that acts on the component there.</p>
</html>"));
end Rotational;
