within Modelica.Electrical.Analog;
package Sensors "Sensors of potential, voltage, current and power"
  extends Modelica.Icons.SensorsPackage;

  model PotentialSensor "Potential of a pin"
    extends Modelica.Icons.RoundSensor;
    Interfaces.PositivePin p "pin";
    Modelica.Blocks.Interfaces.RealOutput phi(unit = "V") "potential";
  equation
    p.i = 0;
    phi = p.v;
  end PotentialSensor;

  model VoltageSensor "Voltage between two pins"
    extends Modelica.Icons.RoundSensor;
    Interfaces.PositivePin p "positive pin";
    Interfaces.NegativePin n "negative pin";
    Modelica.Blocks.Interfaces.RealOutput v(unit = "V") "voltage";
  equation
    p.i = 0;
    n.i = 0;
    v = p.v - n.v;
  end VoltageSensor;

  model CurrentSensor "Current through a wire"
    extends Modelica.Icons.RoundSensor;
    Interfaces.PositivePin p "positive pin";
    Interfaces.NegativePin n "negative pin";
    Modelica.Blocks.Interfaces.RealOutput i(unit = "A") "current from the positive to the negative pin";
  equation
    p.v = n.v;
    i = p.i;
    p.i + n.i = 0;
  end CurrentSensor;

  model PowerSensor "Power from a current and a voltage"
    extends Modelica.Icons.RoundSensor;
    Interfaces.PositivePin pc "positive pin of the current";
    Interfaces.NegativePin nc "negative pin of the current";
    Interfaces.PositivePin pv "positive pin of the voltage";
    Interfaces.NegativePin nv "negative pin of the voltage";
    Modelica.Blocks.Interfaces.RealOutput power(unit = "W") "power";
    VoltageSensor voltageSensor "voltage";
    CurrentSensor currentSensor "current";
    Modelica.Blocks.Math.Product product "power";
  equation
    connect(pc, currentSensor.p);
    connect(currentSensor.n, nc);
    connect(pv, voltageSensor.p);
    connect(voltageSensor.n, nv);
    connect(voltageSensor.v, product.u1);
    connect(currentSensor.i, product.u2);
    connect(product.y, power);
  end PowerSensor;

  model MultiSensor "Current, voltage and power"
    extends Modelica.Icons.RoundSensor;
    Interfaces.PositivePin pc "positive pin of the current";
    Interfaces.NegativePin nc "negative pin of the current";
    Interfaces.PositivePin pv "positive pin of the voltage";
    Interfaces.NegativePin nv "negative pin of the voltage";
    Modelica.Blocks.Interfaces.RealOutput i(final quantity = "ElectricCurrent", final unit = "A") "current";
    Modelica.Blocks.Interfaces.RealOutput v(final quantity = "ElectricPotential", final unit = "V") "voltage";
    Modelica.Blocks.Interfaces.RealOutput power(final quantity = "Power", final unit = "W") "power";
  equation
    pc.v = nc.v;
    pc.i + nc.i = 0;
    pv.i = 0;
    nv.i = 0;
    i = pc.i;
    v = pv.v - nv.v;
    power = v*i;
  end MultiSensor;
end Sensors;
