within Modelica.Mechanics;
package Translational "Rods"
  import Modelica.Units.SI;
  extends Modelica.Icons.Package;
  annotation(Documentation(info = "<html>
<p>A flange holds the position of the end of a rod and the force that acts on the component there.</p>
</html>"));
end Translational;
