within Modelica.Electrical.Analog;
package Ideal "Switches, diodes and other components of ideal behaviour"
  extends Modelica.Icons.Package;

  model Idle "An interruption"
    extends Interfaces.OnePort;
  equation
    i = 0;
  end Idle;

  model Short "A wire"
    extends Interfaces.OnePort;
  equation
    v = 0;
  end Short;

  model IdealDiode "Diode"
    extends Interfaces.IdealSemiconductor;
  equation
    off = s < 0;
  end IdealDiode;

  model IdealThyristor "Diode that begins to conduct where it is fired"
    extends Interfaces.IdealSemiconductor;
    Modelica.Blocks.Interfaces.BooleanInput fire "fires it";
  equation
    off = s < 0 or pre(off) and not fire;
  end IdealThyristor;

  model IdealGTOThyristor "Diode that conducts while it is fired"
    extends Interfaces.IdealSemiconductor;
    Modelica.Blocks.Interfaces.BooleanInput fire "fires it";
  equation
    off = s < 0 or not fire;
  end IdealGTOThyristor;

  model IdealOpeningSwitch "Switch that opens where its input is true"
    extends Interfaces.IdealSwitch;
    Modelica.Blocks.Interfaces.BooleanInput control "open";
  equation
    off = control;
  end IdealOpeningSwitch;

  model IdealClosingSwitch "Switch that closes where its input is true"
    extends Interfaces.IdealSwitch;
    Modelica.Blocks.Interfaces.BooleanInput control "closed";
  equation
    off = not control;
  end IdealClosingSwitch;

  model ControlledIdealOpeningSwitch "Switch that opens where a potential is above a level"
    parameter SI.Voltage level = 0.5 "the level";
    extends Interfaces.IdealSwitch;
    Interfaces.Pin control "pin of the potential";
  equation
    control.i = 0;
    off = control.v > level;
  end ControlledIdealOpeningSwitch;

  model ControlledIdealClosingSwitch "Switch that closes where a potential is above a level"
    parameter SI.Voltage level = 0.5 "the level";
    extends Interfaces.IdealSwitch;
    Interfaces.Pin control "pin of the potential";
  equation
    control.i = 0;
    off = not (control.v > level);
  end ControlledIdealClosingSwitch;

  partial model TwoWaySwitch "Switch between two pins"
    parameter SI.Resistance Ron(final min = 0) = 1e-5 "resistance of a closed way";
    parameter SI.Conductance Goff(final min = 0) = 1e-5 "conductance of an open way";
    extends Interfaces.ConditionalHeatPort(final T = 293.15);
    Interfaces.PositivePin p "pin of both ways";
    Interfaces.NegativePin n2 "other end of the second way";
    Interfaces.NegativePin n1 "other end of the first way";
  protected
    Boolean second "the second way is closed, else the first";
    Real s1(final unit = "1") "the voltage of the open first way, or the current of the closed one";
    Real s2(final unit = "1") "the same of the second way";
    constant SI.Voltage unitVoltage = 1 "for the units";
    constant SI.Current unitCurrent = 1 "for the units";
  equation
    p.v - n1.v = s1*unitVoltage*(if second then 1 else Ron*unitCurrent/unitVoltage);
    n1.i = -s1*unitCurrent*(if second then Goff*unitVoltage/unitCurrent else 1);
    p.v - n2.v = s2*unitVoltage*(if second then Ron*unitCurrent/unitVoltage else 1);
    n2.i = -s2*unitCurrent*(if second then 1 else Goff*unitVoltage/unitCurrent);
    p.i + n1.i + n2.i = 0;
    LossPower = p.i*p.v + n1.i*n1.v + n2.i*n2.v;
  end TwoWaySwitch;

  model IdealTwoWaySwitch "Switch between two pins"
    extends TwoWaySwitch;
    Modelica.Blocks.Interfaces.BooleanInput control "true: p to n2, false: p to n1";
  equation
    second = control;
  end IdealTwoWaySwitch;

  model IdealCommutingSwitch "Switch between two pins (name until version 3)"
    extends IdealTwoWaySwitch;
  end IdealCommutingSwitch;

  model ControlledIdealTwoWaySwitch "Switch between two pins by a potential"
    parameter SI.Voltage level = 0.5 "above it: p to n2, else p to n1";
    extends TwoWaySwitch;
    Interfaces.Pin control "pin of the potential";
  equation
    control.i = 0;
    second = control.v > level;
  end ControlledIdealTwoWaySwitch;

  model ControlledIdealCommutingSwitch "Switch between two pins by a potential (name until version 3)"
    extends ControlledIdealTwoWaySwitch;
  end ControlledIdealCommutingSwitch;

  partial model IntermediateSwitch "Two wires that may be crossed"
    parameter SI.Resistance Ron(final min = 0) = 1e-5 "resistance of a closed way";
    parameter SI.Conductance Goff(final min = 0) = 1e-5 "conductance of an open way";
    extends Interfaces.ConditionalHeatPort(final T = 293.15);
    Interfaces.PositivePin p1 "first pin";
    Interfaces.PositivePin p2 "second pin";
    Interfaces.NegativePin n1 "other end of the first wire";
    Interfaces.NegativePin n2 "other end of the second wire";
  protected
    Boolean crossed "p1 to n2 and p2 to n1, else p1 to n1 and p2 to n2";
    Real s[2, 2](each final unit = "1") "voltage of an open way, or current of a closed one, by pins";
    constant SI.Voltage unitVoltage = 1 "for the units";
    constant SI.Current unitCurrent = 1 "for the units";
    final parameter Real r = Ron*unitCurrent/unitVoltage "resistance without unit";
    final parameter Real g = Goff*unitVoltage/unitCurrent "conductance without unit";
  equation
    p1.v - n1.v = s[1, 1]*unitVoltage*(if crossed then 1 else r);
    p2.v - n2.v = s[2, 2]*unitVoltage*(if crossed then 1 else r);
    p1.v - n2.v = s[1, 2]*unitVoltage*(if crossed then r else 1);
    p2.v - n1.v = s[2, 1]*unitVoltage*(if crossed then r else 1);
    p1.i = unitCurrent*(if crossed then g*s[1, 1] + s[1, 2] else s[1, 1] + g*s[1, 2]);
    p2.i = unitCurrent*(if crossed then g*s[2, 2] + s[2, 1] else s[2, 2] + g*s[2, 1]);
    n1.i = -unitCurrent*(if crossed then g*s[1, 1] + s[2, 1] else s[1, 1] + g*s[2, 1]);
    n2.i = -unitCurrent*(if crossed then g*s[2, 2] + s[1, 2] else s[2, 2] + g*s[1, 2]);
    LossPower = p1.i*p1.v + p2.i*p2.v + n1.i*n1.v + n2.i*n2.v;
  end IntermediateSwitch;

  model IdealIntermediateSwitch "Two wires that may be crossed"
    extends IntermediateSwitch;
    Modelica.Blocks.Interfaces.BooleanInput control "crossed";
  equation
    crossed = control;
  end IdealIntermediateSwitch;

  model ControlledIdealIntermediateSwitch "Two wires that a potential crosses"
    parameter SI.Voltage level = 0.5 "crossed above it";
    extends IntermediateSwitch;
    Interfaces.Pin control "pin of the potential";
  equation
    control.i = 0;
    crossed = control.v > level;
  end ControlledIdealIntermediateSwitch;

  model IdealOpAmp "Amplifier of endless gain, with two pins at the output"
    extends Interfaces.TwoPort;
  equation
    v1 = 0;
    i1 = 0;
  end IdealOpAmp;

  model IdealOpAmp3Pin "Amplifier of endless gain, with one pin at the output"
    Interfaces.PositivePin in_p "positive input";
    Interfaces.NegativePin in_n "negative input";
    Interfaces.PositivePin out "output";
  equation
    in_p.v = in_n.v;
    in_p.i = 0;
    in_n.i = 0;
  end IdealOpAmp3Pin;

  model IdealOpAmpLimited "Amplifier of endless gain, limited by its supply"
    Interfaces.PositivePin in_p "positive input";
    Interfaces.NegativePin in_n "negative input";
    Interfaces.PositivePin out "output";
    Interfaces.PositivePin VMax "positive supply";
    Interfaces.NegativePin VMin "negative supply";
    SI.Voltage vin "voltage between the inputs";
  protected
    Real s(start = 0, final unit = "1") "output between -1 and 1; beyond: voltage between the inputs";
    constant SI.Voltage unitVoltage = 1 "for the units";
  equation
    in_p.i = 0;
    in_n.i = 0;
    VMax.i = 0;
    VMin.i = 0;
    vin = in_p.v - in_n.v;
    vin = unitVoltage*(if s < -1 then s + 1 elseif s > 1 then s - 1 else 0);
    out.v = if s < -1 then VMin.v elseif s > 1 then VMax.v else (VMax.v*(s + 1) - VMin.v*(s - 1))/2;
  end IdealOpAmpLimited;

  model IdealTransformer "Transformer without losses"
    extends Interfaces.TwoPort;
    parameter Real n(start = 1) "turns of the first winding over those of the second";
    parameter Boolean considerMagnetization = false "it has a magnetizing inductance";
    parameter SI.Inductance Lm1(start = 1) "magnetizing inductance, seen from the first winding";
  protected
    SI.Current im1 "magnetizing current";
    SI.MagneticFlux psim1 "magnetizing flux";
  equation
    v1 = n*v2;
    im1 = i1 + i2/n;
    if considerMagnetization then
      psim1 = Lm1*im1;
      v1 = der(psim1);
    else
      psim1 = 0;
      im1 = 0;
    end if;
  end IdealTransformer;
end Ideal;
