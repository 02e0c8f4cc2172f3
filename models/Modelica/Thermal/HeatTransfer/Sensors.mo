within Modelica.Thermal.HeatTransfer;
package Sensors "Sensors of temperature and heat flow"
  extends Modelica.Icons.SensorsPackage;

  model TemperatureSensor "Temperature in kelvin"
    Modelica.Blocks.Interfaces.RealOutput T(unit = "K") "temperature";
    Interfaces.HeatPort_a port "port";
  equation
    T = port.T;
    port.Q_flow = 0;
  end TemperatureSensor;

  model RelTemperatureSensor "Difference of two temperatures"
    Interfaces.HeatPort_a port_a "first port";
    Interfaces.HeatPort_b port_b "second port";
    Modelica.Blocks.Interfaces.RealOutput T_rel(unit = "K", displayUnit = "K")
      "temperature of port_a less that of port_b";
  equation
    T_rel = port_a.T - port_b.T;
    port_a.Q_flow = 0;
    port_b.Q_flow = 0;
  end RelTemperatureSensor;

  model HeatFlowSensor "Heat that flows through"
    Modelica.Blocks.Interfaces.RealOutput Q_flow(unit = "W") "heat from port_a to port_b";
    Interfaces.HeatPort_a port_a "first port";
    Interfaces.HeatPort_b port_b "second port";
  equation
    port_a.T = port_b.T;
    port_a.Q_flow + port_b.Q_flow = 0;
    Q_flow = port_a.Q_flow;
  end HeatFlowSensor;
end Sensors;
