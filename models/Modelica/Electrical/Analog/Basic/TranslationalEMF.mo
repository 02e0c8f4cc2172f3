within Modelica.Electrical.Analog.Basic;
model TranslationalEMF "Linear motor without losses: voltage over velocity is force over current"
  parameter Boolean useSupport = false "there is a flange of the housing";
  parameter SI.ElectricalForceConstant k(start = 1) "force over current";
  SI.Voltage v "voltage";
  SI.Current i "current";
  SI.Position s "position of the rod against the housing";
  SI.Velocity vel "velocity of the rod against the housing";
  SI.Force f "force on the flange";
  SI.Force fElectrical "force of the current";
  Interfaces.PositivePin p "positive pin";
  Interfaces.NegativePin n "negative pin";
  Modelica.Mechanics.Translational.Interfaces.Flange_b flange "rod";
  Modelica.Mechanics.Translational.Interfaces.Support support if useSupport "housing";
protected
  Modelica.Mechanics.Translational.Components.Fixed fixed if not useSupport "housing that stands";
  Modelica.Mechanics.Translational.Interfaces.InternalSupport internalSupport(f = -f) "housing";
equation
  v = p.v - n.v;
  i = p.i;
  p.i + n.i = 0;
  s = flange.s - internalSupport.s;
  vel = der(s);
  k*vel = v;
  f = flange.f;
  fElectrical = k*i;
  f = -fElectrical;
  connect(internalSupport.flange, support);
  connect(internalSupport.flange, fixed.flange);
end TranslationalEMF;
