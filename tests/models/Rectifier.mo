model Rectifier "A bridge of diodes charges a capacitor with a load"
  import Modelica.Electrical.Analog;
  Analog.Sources.SineVoltage source(V = 10, f = 50);
  Analog.Ideal.IdealDiode diode[4](each Ron = 0.1, each Goff = 1e-6, each Vknee = 0.7);
  Analog.Basic.Capacitor capacitor(C = 1e-3, v(start = 0, fixed = true));
  Analog.Basic.Resistor load(R = 50);
  Analog.Basic.Ground ground;
equation
  connect(source.p, diode[1].p);
  connect(diode[1].n, capacitor.p);
  connect(source.n, diode[2].p);
  connect(diode[2].n, capacitor.p);
  connect(diode[3].n, source.p);
  connect(diode[3].p, capacitor.n);
  connect(diode[4].n, source.n);
  connect(diode[4].p, capacitor.n);
  connect(load.p, capacitor.p);
  connect(load.n, capacitor.n);
  connect(ground.p, capacitor.n);
  annotation(experiment(StopTime = 0.05, Interval = 1e-4, Tolerance = 1e-8));
end Rectifier;
