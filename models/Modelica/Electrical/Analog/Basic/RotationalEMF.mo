within Modelica.Electrical.Analog.Basic;
model RotationalEMF "Electric motor without losses: voltage over speed is torque over current"
  parameter Boolean useSupport = false "there is a flange of the housing";
  parameter SI.ElectricalTorqueConstant k(start = 1) "torque over current";
  SI.Voltage v "voltage";
  SI.Current i "current";
  SI.Angle phi "angle of the shaft against the housing";
  SI.AngularVelocity w "speed of the shaft against the housing";
  SI.Torque tau "torque on the flange";
  SI.Torque tauElectrical "torque of the current";
  Interfaces.PositivePin p "positive pin";
  Interfaces.NegativePin n "negative pin";
  Modelica.Mechanics.Rotational.Interfaces.Flange_b flange "shaft";
  Modelica.Mechanics.Rotational.Interfaces.Support support if useSupport "housing";
protected
  Modelica.Mechanics.Rotational.Components.Fixed fixed if not useSupport "housing that stands";
  Modelica.Mechanics.Rotational.Interfaces.InternalSupport internalSupport(tau = -tau) "housing";
equation
  v = p.v - n.v;
  i = p.i;
  p.i + n.i = 0;
  phi = flange.phi - internalSupport.phi;
  w = der(phi);
  k*w = v;
  tau = flange.tau;
  tauElectrical = k*i;
  tau = -tauElectrical;
  connect(internalSupport.flange, support);
  connect(internalSupport.flange, fixed.flange);
end RotationalEMF;
