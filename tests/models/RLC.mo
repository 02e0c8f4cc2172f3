model RLC "A charged capacitor rings through an inductor and a warming resistor"
  import Modelica.Electrical.Analog.Basic;
  import Modelica.Thermal.HeatTransfer;
  Basic.Capacitor capacitor(C = 1e-4, v(start = 5, fixed = true));
  Basic.Inductor inductor(L = 0.1, i(start = 0, fixed = true));
  Basic.Resistor resistor(R = 4, useHeatPort = true);
  Basic.Ground ground;
  HeatTransfer.Components.HeatCapacitor body(C = 0.01, T(start = 300, fixed = true));
equation
  connect(capacitor.p, inductor.p);
  connect(inductor.n, resistor.p);
  connect(resistor.n, capacitor.n);
  connect(ground.p, capacitor.n);
  connect(resistor.heatPort, body.port);
  annotation(experiment(StopTime = 0.05, Tolerance = 1e-9));
end RLC;
