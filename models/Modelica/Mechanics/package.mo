within Modelica;
package Mechanics "Mechanical systems"
  extends Modelica.Icons.Package;
end Mechanics;
