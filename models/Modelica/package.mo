package Modelica "Small standard library: units, mathematics, blocks, electrical, thermal and mechanical components"
  extends Modelica.Icons.Package;
  annotation(
    version = "4.0.0",
    Documentation(info = "<html>
<p>The part of the Modelica Standard Library that models of physical systems use most, written
anew for this program: names, connectors, parameters and defaults are those of the standard
library, equations and texts are not. It is loaded when a model names a class of
<code>Modelica</code> and no other library of that name is found; a library given with
<code>--library</code> or in <code>MODELICAPATH</code> takes its place.</p>
<p>Types of quantities are in <a href=\"modelica://Modelica.Units.SI\">Units.SI</a>, as in version 4,
and under their former name <a href=\"modelica://Modelica.SIunits\">SIunits</a>, as in versions 1 to
3, so that models of any age find theirs.</p>
</html>"));
end Modelica;
