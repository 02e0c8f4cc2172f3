within Modelica.Mechanics;
package Rotational "Shafts"
  import Modelica.Units.SI;
  extends Modelica.Icons.Package;
  annotation(Documentation(info = "<html>
<p>A flange holds the angle of a shaft and the torque that acts on the component there.</p>
</html>"));
end Rotational;
