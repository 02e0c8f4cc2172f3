within Modelica;
package Electrical "Electrical systems"
  extends Modelica.Icons.Package;
end Electrical;
