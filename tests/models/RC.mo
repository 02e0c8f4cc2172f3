model RC "A capacitor is charged through a resistor from 0.1 s on"
  import Modelica.Electrical.Analog;
  Analog.Sources.StepVoltage source(V = 10, startTime = 0.1);
  Analog.Basic.Resistor resistor(R = 100);
  Analog.Basic.Capacitor capacitor(C = 1e-3, v(start = 0, fixed = true));
  Analog.Basic.Ground ground;
  Analog.Sensors.CurrentSensor current;
  Analog.Sensors.VoltageSensor voltage;
  Analog.Sensors.PotentialSensor potential;
equation
  connect(source.p, current.p);
  connect(current.n, resistor.p);
  connect(resistor.n, capacitor.p);
  connect(capacitor.n, source.n);
  connect(ground.p, source.n);
  connect(voltage.p, capacitor.p);
  connect(voltage.n, capacitor.n);
  connect(potential.p, source.p);
  annotation(experiment(StopTime = 0.5, Tolerance = 1e-8));
end RC;
