model Version2 "Names as models of 2005 have them"
  import Modelica.SIunits;
  import NonSI = Modelica.SIunits.Conversions.NonSIunits;
  parameter SIunits.Temp_K T0 = 300;
  parameter NonSI.Temperature_degC T0_degC = SIunits.Conversions.to_degC(T0);
  Modelica.Thermal.HeatTransfer.HeatCapacitor body(C = 10, T(start = T0, fixed = true));
  Modelica.Thermal.HeatTransfer.ThermalConductor conductor(G = 1);
  Modelica.Thermal.HeatTransfer.FixedTemperature bath(T = 350);
  Modelica.Electrical.Analog.Sources.SineVoltage source(V = 2, freqHz = 0.25);
  Modelica.Electrical.Analog.Basic.Resistor resistor(R = 4);
  Modelica.Electrical.Analog.Basic.Ground ground;
  Modelica.Blocks.Sources.Clock clock;
equation
  connect(body.port, conductor.port_a);
  connect(conductor.port_b, bath.port);
  connect(source.p, resistor.p);
  connect(source.n, resistor.n);
  connect(source.n, ground.p);
  annotation(experiment(StopTime = 1, Tolerance = 1e-9));
end Version2;
