within Modelica.Thermal.HeatTransfer;
package Interfaces "Heat ports, and components by their ports"
  extends Modelica.Icons.InterfacesPackage;

  partial connector HeatPort "Place where heat flows"
    SI.Temperature T "temperature of the place";
    flow SI.HeatFlowRate Q_flow "heat that flows into the component";
  end HeatPort;

  connector HeatPort_a "Place where heat flows, first of two"
    extends HeatPort;
  end HeatPort_a;

  connector HeatPort_b "Place where heat flows, second of two"
    extends HeatPort;
  end HeatPort_b;

  partial model Element1D "Heat flows from port to port, none is stored"
    SI.HeatFlowRate Q_flow "heat from port_a to port_b";
    SI.TemperatureDifference dT "temperature of port_a less that of port_b";
    HeatPort_a port_a "first port";
    HeatPort_b port_b "second port";
  equation
    dT = port_a.T - port_b.T;
    port_a.Q_flow = Q_flow;
    port_b.Q_flow = -Q_flow;
  end Element1D;

  partial model PartialElementaryConditionalHeatPort "A component that may give its losses to a heat port"
    parameter Boolean useHeatPort = false "there is a heat port";
    parameter SI.Temperature T = 293.15 "temperature without a heat port";
    HeatPort_a heatPort(final T = TheatPort, final Q_flow = -lossPower) if useHeatPort "where the losses go";
    SI.Power lossPower "losses";
    SI.Temperature TheatPort "temperature of the component";
  equation
    if not useHeatPort then
      TheatPort = T;
    end if;
  end PartialElementaryConditionalHeatPort;

  partial model PartialElementaryConditionalHeatPortWithoutT
    "A component that may give its losses to a heat port, whose temperature does not matter"
    parameter Boolean useHeatPort = false "there is a heat port";
    HeatPort_a heatPort(final Q_flow = -lossPower) if useHeatPort "where the losses go";
    SI.Power lossPower "losses";
  end PartialElementaryConditionalHeatPortWithoutT;

  partial model PartialConditionalHeatPort "A composed component that may give its losses to a heat port"
    parameter Boolean useHeatPort = false "there is a heat port";
    parameter SI.Temperature T = 293.15 "temperature without a heat port";
    HeatPort_a heatPort if useHeatPort "where the losses go";
    Sources.FixedTemperature fixedTemperature(final T = T) if not useHeatPort "where they go without it";
  protected
    HeatPort_a internalHeatPort "to be connected inside";
  equation
    connect(heatPort, internalHeatPort);
    connect(fixedTemperature.port, internalHeatPort);
  end PartialConditionalHeatPort;
end Interfaces;
