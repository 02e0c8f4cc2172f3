model TableSource "A capacitor follows a voltage that is given by points"
  import Modelica.Electrical.Analog;
  Analog.Sources.TableVoltage source(table = [0, 0; 0.5, 2; 0.5, 1; 1, 1; 2, -1], startTime = 0.25, offset = 0.5);
  Analog.Basic.Resistor resistor(R = 10);
  Analog.Basic.Capacitor capacitor(C = 0.02, v(start = 0, fixed = true));
  Analog.Basic.Ground ground;
equation
  connect(source.p, resistor.p);
  connect(resistor.n, capacitor.p);
  connect(capacitor.n, source.n);
  connect(ground.p, source.n);
  annotation(experiment(StopTime = 3, Tolerance = 1e-9));
end TableSource;
