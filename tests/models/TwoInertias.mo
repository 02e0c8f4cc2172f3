model TwoInertias "Two shafts with a spring between them; the first is driven by a step of torque"
  import Modelica.Mechanics.Rotational;
  Rotational.Sources.TorqueStep torque(stepTorque = 2, offsetTorque = 0, startTime = 0.5);
  Rotational.Components.Inertia first(J = 1, phi(start = 0, fixed = true), w(start = 0, fixed = true));
  Rotational.Components.SpringDamper spring(c = 20, d = 0.5);
  Rotational.Components.Inertia second(J = 2, phi(start = 0, fixed = true), w(start = 0, fixed = true));
  Rotational.Sensors.PowerSensor power;
equation
  connect(torque.flange, power.flange_a);
  connect(power.flange_b, first.flange_a);
  connect(first.flange_b, spring.flange_a);
  connect(spring.flange_b, second.flange_a);
  annotation(experiment(StopTime = 2, Tolerance = 1e-9));
end TwoInertias;
