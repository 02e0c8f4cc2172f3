within Modelica.Thermal.HeatTransfer;
package Sources "Given temperatures and heat flows"
  extends Modelica.Icons.SourcesPackage;

  model FixedTemperature "Constant temperature"
    parameter SI.Temperature T "temperature";
    Interfaces.HeatPort_b port "port";
  equation
    port.T = T;
  end FixedTemperature;

  model PrescribedTemperature "Temperature that is an input"
    Interfaces.HeatPort_b port "port";
    Modelica.Blocks.Interfaces.RealInput T(unit = "K") "temperature";
  equation
    port.T = T;
  end PrescribedTemperature;

  model FixedHeatFlow "Heat flow that may depend on the temperature"
    parameter SI.HeatFlowRate Q_flow "heat that flows out of the port at the reference temperature";
    parameter SI.Temperature T_ref = 293.15 "reference temperature";
    parameter SI.LinearTemperatureCoefficient alpha = 0 "relative change of the flow per kelvin";
    Interfaces.HeatPort_b port "port";
  equation
    port.Q_flow = -Q_flow*(1 + alpha*(port.T - T_ref));
  end FixedHeatFlow;

  model PrescribedHeatFlow "Heat flow that is an input and may depend on the temperature"
    parameter SI.Temperature T_ref = 293.15 "reference temperature";
    parameter SI.LinearTemperatureCoefficient alpha = 0 "relative change of the flow per kelvin";
    Modelica.Blocks.Interfaces.RealInput Q_flow(unit = "W")
      "heat that flows out of the port at the reference temperature";
    Interfaces.HeatPort_b port "port";
  equation
    port.Q_flow = -Q_flow*(1 + alpha*(port.T - T_ref));
  end PrescribedHeatFlow;
end Sources;
