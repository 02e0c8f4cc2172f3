model Switches "An inductor is switched on, over to a freewheeling diode, and on again"
  import Modelica.Electrical.Analog;
  Analog.Sources.ConstantVoltage source(V = 12);
  Analog.Ideal.IdealClosingSwitch switch_(Ron = 1e-3, Goff = 1e-6);
  Analog.Basic.Resistor resistor(R = 2);
  Analog.Basic.Inductor inductor(L = 0.01, i(start = 0, fixed = true));
  Analog.Ideal.IdealDiode diode(Ron = 1e-3, Goff = 1e-6);
  Analog.Basic.Ground ground;
  Modelica.Blocks.Sources.BooleanPulse pulse(width = 50, period = 0.01);
equation
  connect(source.p, switch_.p);
  connect(switch_.n, resistor.p);
  connect(resistor.n, inductor.p);
  connect(inductor.n, source.n);
  connect(diode.n, resistor.p);
  connect(diode.p, source.n);
  connect(ground.p, source.n);
  connect(pulse.y, switch_.control);
  annotation(experiment(StopTime = 0.018, Interval = 1e-4, Tolerance = 1e-9));
end Switches;
