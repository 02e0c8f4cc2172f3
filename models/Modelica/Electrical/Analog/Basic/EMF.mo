within Modelica.Electrical.Analog.Basic;
model EMF "Electric motor without losses (name until version 3)"
  extends RotationalEMF;
end EMF;
