within Modelica.Thermal;
package HeatTransfer "Heat stored and transferred in lumped components"
  import Modelica.Units.SI;
  extends Modelica.Icons.Package;

  // Where version 2 had them.
  model HeatCapacitor = Components.HeatCapacitor;
  model ThermalConductor = Components.ThermalConductor;
  model Convection = Components.Convection;
  model BodyRadiation = Components.BodyRadiation;
  model FixedTemperature = Sources.FixedTemperature;
  model PrescribedTemperature = Sources.PrescribedTemperature;
  model FixedHeatFlow = Sources.FixedHeatFlow;
  model PrescribedHeatFlow = Sources.PrescribedHeatFlow;
  model TemperatureSensor = Sensors.TemperatureSensor;
  model RelTemperatureSensor = Sensors.RelTemperatureSensor;
  model HeatFlowSensor = Sensors.HeatFlowSensor;
  annotation(Documentation(info = "<html>
<p>A heat port holds the temperature of a place and the heat that flows into a component there.</p>
</html>"));
end HeatTransfer;
