model Wall "A wall of layers between two temperatures"
  import Modelica.Thermal.HeatTransfer;
  parameter Integer n = 5 "number of layers";
  HeatTransfer.Components.HeatCapacitor layer[n](each C = 100, each T(start = 293.15, fixed = true));
  HeatTransfer.Components.ThermalConductor between[n - 1](each G = 5);
  HeatTransfer.Components.ThermalResistor inside(R = 0.1);
  HeatTransfer.Components.Convection outside;
  HeatTransfer.Sources.FixedTemperature warm(T = 353.15);
  HeatTransfer.Celsius.PrescribedTemperature cold;
  HeatTransfer.Sensors.HeatFlowSensor flow_;
  Modelica.Blocks.Sources.Constant conductance(k = 2);
  Modelica.Blocks.Sources.Constant temperature(k = 10);
equation
  connect(warm.port, flow_.port_a);
  connect(flow_.port_b, inside.port_a);
  connect(inside.port_b, layer[1].port);
  for i in 1:n - 1 loop
    connect(layer[i].port, between[i].port_a);
    connect(between[i].port_b, layer[i + 1].port);
  end for;
  connect(layer[n].port, outside.solid);
  connect(outside.fluid, cold.port);
  connect(conductance.y, outside.Gc);
  connect(temperature.y, cold.T);
  annotation(experiment(StopTime = 100, Tolerance = 1e-9));
end Wall;
