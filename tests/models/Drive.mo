model Drive "The speed of a motor with a load is controlled"
  import Modelica.Blocks;
  import Modelica.Electrical.Analog;
  import Modelica.Mechanics.Rotational;
  Blocks.Sources.Step speed(height = 10, startTime = 0);
  Blocks.Continuous.LimPID controller(
    controllerType = Modelica.Blocks.Types.SimpleController.PI, k = 2, Ti = 0.1, yMax = 1000);
  Analog.Sources.SignalVoltage source;
  Analog.Basic.Resistor resistor(R = 0.5);
  Analog.Basic.Inductor inductor(L = 0.05, i(start = 0, fixed = true));
  Analog.Basic.EMF emf(k = 1);
  Analog.Basic.Ground ground;
  Rotational.Components.Inertia motor(J = 0.1, phi(start = 0, fixed = true), w(start = 0, fixed = true));
  Rotational.Components.IdealGear gear(ratio = 2);
  Rotational.Components.Inertia load(J = 0.4);
  Rotational.Components.Damper damper(d = 0.2);
  Rotational.Components.Fixed fixed;
  Rotational.Sensors.SpeedSensor sensor;
equation
  connect(speed.y, controller.u_s);
  connect(controller.y, source.v);
  connect(source.p, resistor.p);
  connect(resistor.n, inductor.p);
  connect(inductor.n, emf.p);
  connect(emf.n, source.n);
  connect(ground.p, source.n);
  connect(emf.flange, motor.flange_a);
  connect(motor.flange_b, gear.flange_a);
  connect(gear.flange_b, load.flange_a);
  connect(load.flange_b, damper.flange_a);
  connect(damper.flange_b, fixed.flange);
  connect(sensor.flange, motor.flange_b);
  connect(sensor.w, controller.u_m);
  annotation(experiment(StopTime = 1, Tolerance = 1e-9));
end Drive;
