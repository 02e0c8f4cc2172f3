within Modelica.Electrical;
package Analog "Circuits of analog components"
  import Modelica.Units.SI;
  extends Modelica.Icons.Package;
  annotation(Documentation(info = "<html>
<p>Components with pins. A current that flows into a component at a pin is positive there. Each
circuit has at least one <a href=\"modelica://Modelica.Electrical.Analog.Basic.Ground\">ground</a>.</p>
</html>"));
end Analog;
