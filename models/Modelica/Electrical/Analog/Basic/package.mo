within Modelica.Electrical.Analog;
package Basic "Resistors, capacitors, inductors and what goes with them"
  extends Modelica.Icons.Package;

  model Ground "Potential zero"
    Interfaces.Pin p "pin";
  equation
    p.v = 0;
  end Ground;

  model Resistor "Linear resistor whose resistance may depend on the temperature"
    parameter SI.Resistance R(start = 1) "resistance at the reference temperature";
    parameter SI.Temperature T_ref = 300.15 "reference temperature";
    parameter SI.LinearTemperatureCoefficient alpha = 0 "relative change of the resistance per kelvin";
    extends Interfaces.OnePort;
    extends Interfaces.ConditionalHeatPort(T = T_ref);
    SI.Resistance R_actual "resistance";
  equation
    assert(1 + alpha*(T_heatPort - T_ref) >= Modelica.Constants.eps, "the resistance is not positive at this temperature");
    R_actual = R*(1 + alpha*(T_heatPort - T_ref));
    v = R_actual*i;
    LossPower = v*i;
  end Resistor;

  model HeatingResistor "Resistor with a heat port"
    extends Interfaces.OnePort;
    parameter SI.Resistance R_ref(start = 1) "resistance at the reference temperature";
    parameter SI.Temperature T_ref = 300.15 "reference temperature";
    parameter SI.LinearTemperatureCoefficient alpha = 0 "relative change of the resistance per kelvin";
    extends Interfaces.ConditionalHeatPort(T = T_ref, useHeatPort = true);
    SI.Resistance R "resistance";
  equation
    R = R_ref*(1 + alpha*(T_heatPort - T_ref));
    v = R*i;
    LossPower = v*i;
  end HeatingResistor;

  model Conductor "Linear conductor whose conductance may depend on the temperature"
    parameter SI.Conductance G(start = 1) "conductance at the reference temperature";
    parameter SI.Temperature T_ref = 300.15 "reference temperature";
    parameter SI.LinearTemperatureCoefficient alpha = 0 "relative change of the resistance per kelvin";
    extends Interfaces.OnePort;
    extends Interfaces.ConditionalHeatPort(T = T_ref);
    SI.Conductance G_actual "conductance";
  equation
    assert(1 + alpha*(T_heatPort - T_ref) >= Modelica.Constants.eps, "the conductance is not positive at this temperature");
    G_actual = G/(1 + alpha*(T_heatPort - T_ref));
    i = G_actual*v;
    LossPower = v*i;
  end Conductor;

  model Capacitor "Linear capacitor"
    extends Interfaces.OnePort(v(start = 0));
    parameter SI.Capacitance C(start = 1) "capacitance";
  equation
    C*der(v) = i;
  end Capacitor;

  model Inductor "Linear inductor"
    extends Interfaces.OnePort(i(start = 0));
    parameter SI.Inductance L(start = 1) "inductance";
  equation
    L*der(i) = v;
  end Inductor;

  model SaturatingInductor "Inductor whose inductance falls with the current"
    extends Interfaces.OnePort(i(start = 0));
    parameter SI.Current Inom(start = 1) "nominal current";
    parameter SI.Inductance Lnom(start = 1) "inductance at the nominal current";
    parameter SI.Inductance Lzer(start = 2*Lnom) "inductance near zero";
    parameter SI.Inductance Linf(start = Lnom/2) "inductance at large currents";
    SI.Inductance Lact(start = Lzer) "flux over current";
    SI.MagneticFlux Psi "flux";
  protected
    parameter SI.Current Ipar(start = Inom/10, fixed = false) "current of the bend";
  initial equation
    (Lnom - Linf)*Inom = (Lzer - Linf)*Ipar*atan(Inom/Ipar);
  equation
    assert(Lzer > Lnom and Lnom > Linf, "Lzer > Lnom > Linf has to hold");
    Psi = Linf*i + (Lzer - Linf)*Ipar*atan(i/Ipar);
    Lact = Linf + (Lzer - Linf)*(if noEvent(abs(i) < 1e-6*Ipar) then 1 else atan(i/Ipar)*Ipar/i);
    der(Psi) = v;
  end SaturatingInductor;

  model Transformer "Two coupled inductors"
    extends Interfaces.TwoPort(i1(start = 0), i2(start = 0));
    parameter SI.Inductance L1(start = 1) "inductance of the first winding";
    parameter SI.Inductance L2(start = 1) "inductance of the second winding";
    parameter SI.Inductance M(start = 1) "coupling inductance";
  equation
    v1 = L1*der(i1) + M*der(i2);
    v2 = M*der(i1) + L2*der(i2);
  end Transformer;

  model Gyrator "Each current follows the other voltage"
    extends Interfaces.TwoPort;
    parameter SI.Conductance G1(start = 1) "conductance of the first current";
    parameter SI.Conductance G2(start = 1) "conductance of the second current";
  equation
    i1 = G2*v2;
    i2 = -G1*v1;
  end Gyrator;

  model VCV "Voltage that follows a voltage"
    extends Interfaces.TwoPort;
    parameter Real gain(start = 1) "factor";
  equation
    v2 = gain*v1;
    i1 = 0;
  end VCV;

  model VCC "Current that follows a voltage"
    extends Interfaces.TwoPort;
    parameter SI.Conductance transConductance(start = 1) "factor";
  equation
    i2 = transConductance*v1;
    i1 = 0;
  end VCC;

  model CCV "Voltage that follows a current"
    extends Interfaces.TwoPort;
    parameter SI.Resistance transResistance(start = 1) "factor";
  equation
    v2 = transResistance*i1;
    v1 = 0;
  end CCV;

  model CCC "Current that follows a current"
    extends Interfaces.TwoPort;
    parameter Real gain(start = 1) "factor";
  equation
    i2 = gain*i1;
    v1 = 0;
  end CCC;

  model OpAmp "Amplifier that saturates at its supply"
    parameter Real Slope(start = 10000) "gain at the zero of the input";
    Interfaces.PositivePin in_p "positive input";
    Interfaces.NegativePin in_n "negative input";
    Interfaces.PositivePin out "output";
    Interfaces.PositivePin VMax "positive supply";
    Interfaces.NegativePin VMin "negative supply";
    SI.Voltage vin "voltage between the inputs";
  protected
    SI.Voltage half = (VMax.v - VMin.v)/2 "greatest deviation of the output";
    Real x "input over the input where the line of the gain meets the supply";
  equation
    in_p.i = 0;
    in_n.i = 0;
    VMax.i = 0;
    VMin.i = 0;
    vin = in_p.v - in_n.v;
    x*half = abs(Slope)*vin;
    out.v = (VMax.v + VMin.v)/2 + half*x/(1 + noEvent(if x < 0 then -x else x));
  end OpAmp;

  model VariableResistor "Resistor whose resistance is an input"
    parameter SI.Temperature T_ref = 300.15 "reference temperature";
    parameter SI.LinearTemperatureCoefficient alpha = 0 "relative change of the resistance per kelvin";
    extends Interfaces.OnePort;
    extends Interfaces.ConditionalHeatPort(T = T_ref);
    SI.Resistance R_actual "resistance";
    Modelica.Blocks.Interfaces.RealInput R(unit = "Ohm") "resistance at the reference temperature";
  equation
    assert(1 + alpha*(T_heatPort - T_ref) >= Modelica.Constants.eps, "the resistance is not positive at this temperature");
    R_actual = R*(1 + alpha*(T_heatPort - T_ref));
    v = R_actual*i;
    LossPower = v*i;
  end VariableResistor;

  model VariableConductor "Conductor whose conductance is an input"
    parameter SI.Temperature T_ref = 300.15 "reference temperature";
    parameter SI.LinearTemperatureCoefficient alpha = 0 "relative change of the resistance per kelvin";
    extends Interfaces.OnePort;
    extends Interfaces.ConditionalHeatPort(T = T_ref);
    SI.Conductance G_actual "conductance";
    Modelica.Blocks.Interfaces.RealInput G(unit = "S") "conductance at the reference temperature";
  equation
    assert(1 + alpha*(T_heatPort - T_ref) >= Modelica.Constants.eps, "the conductance is not positive at this temperature");
    G_actual = G/(1 + alpha*(T_heatPort - T_ref));
    i = G_actual*v;
    LossPower = v*i;
  end VariableConductor;

  model VariableCapacitor "Capacitor whose capacitance is an input"
    extends Interfaces.OnePort;
    Modelica.Blocks.Interfaces.RealInput C(unit = "F") "capacitance";
    parameter SI.Capacitance Cmin = Modelica.Constants.eps "smallest capacitance";
    parameter SI.Voltage IC = 0 "voltage at the start";
    parameter Boolean UIC = false "the voltage at the start is given";
    SI.ElectricCharge Q "charge";
  initial equation
    if UIC then
      v = IC;
    end if;
  equation
    assert(C >= 0, "the capacitance is negative");
    Q = noEvent(max(C, Cmin))*v;
    der(Q) = i;
  end VariableCapacitor;

  model VariableInductor "Inductor whose inductance is an input"
    extends Interfaces.OnePort;
    Modelica.Blocks.Interfaces.RealInput L(unit = "H") "inductance";
    parameter SI.Inductance Lmin = Modelica.Constants.eps "smallest inductance";
    parameter SI.Current IC = 0 "current at the start";
    parameter Boolean UIC = false "the current at the start is given";
    SI.MagneticFlux Psi "flux";
  initial equation
    if UIC then
      i = IC;
    end if;
  equation
    assert(L >= 0, "the inductance is negative");
    Psi = noEvent(max(L, Lmin))*i;
    der(Psi) = v;
  end VariableInductor;
end Basic;
