within Modelica.Electrical.Analog;
package Interfaces "Pins, and components by their pins"
  extends Modelica.Icons.InterfacesPackage;

  connector Pin "Where components are connected"
    SI.ElectricPotential v "potential";
    flow SI.Current i "current into the component";
  end Pin;

  connector PositivePin "Pin at the positive side of a voltage"
    SI.ElectricPotential v "potential";
    flow SI.Current i "current into the component";
  end PositivePin;

  connector NegativePin "Pin at the negative side of a voltage"
    SI.ElectricPotential v "potential";
    flow SI.Current i "current into the component";
  end NegativePin;

  partial model TwoPin "Two pins and the voltage between them"
    SI.Voltage v "voltage from the positive to the negative pin";
    PositivePin p "positive pin";
    NegativePin n "negative pin";
  equation
    v = p.v - n.v;
  end TwoPin;

  partial model OnePort "Two pins with a current through"
    extends TwoPin;
    SI.Current i "current from the positive to the negative pin";
  equation
    i = p.i;
    p.i + n.i = 0;
  end OnePort;

  partial model FourPin "Two pairs of pins"
    SI.Voltage v1 "voltage of the first pair";
    SI.Voltage v2 "voltage of the second pair";
    SI.Current i1 "current into the first pair";
    SI.Current i2 "current into the second pair";
    PositivePin p1 "positive pin of the first pair";
    NegativePin n1 "negative pin of the first pair";
    PositivePin p2 "positive pin of the second pair";
    NegativePin n2 "negative pin of the second pair";
  equation
    v1 = p1.v - n1.v;
    v2 = p2.v - n2.v;
    i1 = p1.i;
    i2 = p2.i;
  end FourPin;

  partial model TwoPort "Two pairs of pins, each with a current through"
    extends FourPin;
  equation
    p1.i + n1.i = 0;
    p2.i + n2.i = 0;
  end TwoPort;

  partial model ConditionalHeatPort "A component that may give its losses to a heat port"
    parameter Boolean useHeatPort = false "there is a heat port";
    parameter SI.Temperature T = 293.15 "temperature without a heat port";
    Modelica.Thermal.HeatTransfer.Interfaces.HeatPort_a heatPort(
      final T = T_heatPort, final Q_flow = -LossPower) if useHeatPort "where the losses go";
    SI.Power LossPower "losses";
    SI.Temperature T_heatPort "temperature of the component";
  equation
    if not useHeatPort then
      T_heatPort = T;
    end if;
  end ConditionalHeatPort;

  partial model AbsoluteSensor "A sensor of one pin"
    extends Modelica.Icons.RoundSensor;
    PositivePin p "pin";
    Modelica.Blocks.Interfaces.RealOutput y "measured";
  end AbsoluteSensor;

  partial model RelativeSensor "A sensor of two pins"
    extends Modelica.Icons.RoundSensor;
    PositivePin p "positive pin";
    NegativePin n "negative pin";
    Modelica.Blocks.Interfaces.RealOutput y "measured";
  end RelativeSensor;

  partial model VoltageSource "A voltage that follows a source of signals"
    extends Modelica.Electrical.Analog.Icons.VoltageSource;
    extends OnePort;
    parameter SI.Voltage offset = 0 "added to the voltage";
    parameter SI.Time startTime = 0 "until here the voltage is the offset";
    replaceable Modelica.Blocks.Interfaces.SignalSource signalSource(
      final offset = offset, final startTime = startTime) "the signal";
  equation
    v = signalSource.y;
  end VoltageSource;

  partial model CurrentSource "A current that follows a source of signals"
    extends Modelica.Electrical.Analog.Icons.CurrentSource;
    extends OnePort;
    parameter SI.Current offset = 0 "added to the current";
    parameter SI.Time startTime = 0 "until here the current is the offset";
    replaceable Modelica.Blocks.Interfaces.SignalSource signalSource(
      final offset = offset, final startTime = startTime) "the signal";
  equation
    i = signalSource.y;
  end CurrentSource;

  partial model IdealSemiconductor "A valve: a small resistance in one direction, a small conductance in the other"
    extends OnePort;
    parameter SI.Resistance Ron(final min = 0) = 1e-5 "resistance where it conducts";
    parameter SI.Conductance Goff(final min = 0) = 1e-5 "conductance where it blocks";
    parameter SI.Voltage Vknee(final min = 0) = 0 "voltage where it begins to conduct";
    extends ConditionalHeatPort;
    Boolean off(start = true) "it blocks";
  protected
    Real s(start = 0, final unit = "1") "position on the characteristic: the voltage, or the current";
    constant SI.Voltage unitVoltage = 1 "for the units";
    constant SI.Current unitCurrent = 1 "for the units";
  equation
    v = s*unitVoltage*(if off then 1 else Ron*unitCurrent/unitVoltage) + Vknee;
    i = s*unitCurrent*(if off then Goff*unitVoltage/unitCurrent else 1) + Goff*Vknee;
    LossPower = v*i;
  end IdealSemiconductor;

  partial model IdealSwitch "A switch: a small resistance where it is closed, a small conductance where it is open"
    extends OnePort;
    parameter SI.Resistance Ron(final min = 0) = 1e-5 "resistance of the closed switch";
    parameter SI.Conductance Goff(final min = 0) = 1e-5 "conductance of the open switch";
    extends ConditionalHeatPort(final T = 293.15);
  protected
    Boolean off "the switch is open";
    Real s(final unit = "1") "the voltage of the open switch, or the current of the closed one";
    constant SI.Voltage unitVoltage = 1 "for the units";
    constant SI.Current unitCurrent = 1 "for the units";
  equation
    v = s*unitVoltage*(if off then 1 else Ron*unitCurrent/unitVoltage);
    i = s*unitCurrent*(if off then Goff*unitVoltage/unitCurrent else 1);
    LossPower = v*i;
  end IdealSwitch;
end Interfaces;
