within Modelica.Electrical.Analog.Basic;
model Potentiometer "Resistor with a contact between its ends"
  parameter SI.Resistance R(start = 1) "resistance from end to end at the reference temperature";
  parameter SI.Temperature T_ref = 293.15 "reference temperature";
  parameter SI.LinearTemperatureCoefficient alpha = 0 "relative change of the resistance per kelvin";
  extends Interfaces.ConditionalHeatPort(T = T_ref);
  parameter Boolean useRinput = false "the contact is moved by an input";
  parameter Real rConstant(final min = 0, final max = 1) = 0.5 "place of the contact without an input";
  SI.Resistance Rp "resistance from the positive end to the contact";
  SI.Resistance Rn "resistance from the contact to the negative end";
  Interfaces.PositivePin pin_p "positive end";
  Interfaces.PositivePin contact "contact";
  Interfaces.NegativePin pin_n "negative end";
  Modelica.Blocks.Interfaces.RealInput r if useRinput "place of the contact, from 0 to 1";
protected
  Modelica.Blocks.Sources.Constant rConst(final k = rConstant) if not useRinput "place without an input";
  Modelica.Blocks.Interfaces.RealInput rInt "place of the contact";
equation
  connect(r, rInt);
  connect(rConst.y, rInt);
  Rn = max(0, min(1, rInt))*R*(1 + alpha*(T_heatPort - T_ref));
  Rp = (1 - max(0, min(1, rInt)))*R*(1 + alpha*(T_heatPort - T_ref));
  pin_p.v - contact.v = Rp*pin_p.i;
  pin_n.v - contact.v = Rn*pin_n.i;
  pin_p.i + pin_n.i + contact.i = 0;
  LossPower = (pin_p.v - contact.v)*pin_p.i + (pin_n.v - contact.v)*pin_n.i;
end Potentiometer;
