model Thermostat "A heater is switched so that a room keeps its temperature"
  import Modelica.Blocks;
  import Modelica.Thermal.HeatTransfer;
  HeatTransfer.Components.HeatCapacitor room(C = 1000, T(start = 288.15, fixed = true));
  HeatTransfer.Components.ThermalConductor loss(G = 10);
  HeatTransfer.Sources.FixedTemperature outdoors(T = 273.15);
  HeatTransfer.Sources.PrescribedHeatFlow heater;
  HeatTransfer.Celsius.TemperatureSensor sensor;
  Blocks.Logical.OnOffController controller(bandwidth = 1);
  Blocks.Sources.Constant reference(k = 20);
  Blocks.Math.BooleanToReal power(realTrue = 500);
equation
  connect(room.port, loss.port_a);
  connect(loss.port_b, outdoors.port);
  connect(heater.port, room.port);
  connect(sensor.port, room.port);
  connect(sensor.T, controller.u);
  connect(reference.y, controller.reference);
  connect(controller.y, power.u);
  connect(power.y, heater.Q_flow);
  annotation(experiment(StopTime = 60, Tolerance = 1e-9));
end Thermostat;
