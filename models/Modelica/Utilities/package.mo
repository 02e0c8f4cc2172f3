within Modelica;
package Utilities "Texts, files and the system, for scripts"
  extends Modelica.Icons.UtilitiesPackage;
  annotation(Documentation(info = "<html>
<p>Functions outside of Modelica are those that the standard library calls, under the same names.</p>
</html>"));
end Utilities;
