model Radiation "A hot body radiates into empty space"
  import Modelica.Thermal.HeatTransfer;
  HeatTransfer.Components.HeatCapacitor body(C = 10, T(start = 1000, fixed = true));
  HeatTransfer.Components.BodyRadiation radiation(Gr = 0.01);
  HeatTransfer.Sources.FixedTemperature space(T = 0);
equation
  connect(body.port, radiation.port_a);
  connect(radiation.port_b, space.port);
  annotation(experiment(StopTime = 60, Tolerance = 1e-9));
end Radiation;
