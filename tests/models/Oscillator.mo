model Oscillator "A mass on a spring and a damper is driven by a force"
  import Modelica.Mechanics.Translational;
  Translational.Components.Mass mass(m = 2, s(start = 0.1, fixed = true), v(start = 0, fixed = true));
  Translational.Components.Spring spring(c = 50, s_rel0 = 0);
  Translational.Components.Damper damper(d = 4);
  Translational.Components.Fixed fixed;
  Translational.Sources.Force force;
  Translational.Sensors.PositionSensor position;
  Modelica.Blocks.Sources.Sine sine(amplitude = 3, f = 0.5);
equation
  connect(fixed.flange, spring.flange_a);
  connect(spring.flange_b, mass.flange_a);
  connect(fixed.flange, damper.flange_a);
  connect(damper.flange_b, mass.flange_a);
  connect(mass.flange_b, force.flange);
  connect(sine.y, force.f);
  connect(position.flange, mass.flange_b);
  annotation(experiment(StopTime = 3, Tolerance = 1e-9));
end Oscillator;
