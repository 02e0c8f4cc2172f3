within Modelica.Thermal;
package HeatTransfer "Heat stored and transferred in lumped components"
  import Modelica.Units.SI;
  extends Modelica.Icons.Package;
  annotation(Documentation(info = "<html>
<p>A heat port holds the temperature of a place and the heat that flows into a component there.</p>
</html>"));
end HeatTransfer;
