within Modelica;
package Units "Types of physical quantities"
  extends Modelica.Icons.Package;
  annotation(Documentation(info = "<html>
<p>Types of quantities in SI units, in other units, and functions between the two.</p>
</html>"));
end Units;
