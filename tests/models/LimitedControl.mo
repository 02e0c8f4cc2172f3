model LimitedControl "A PID controller whose output is limited, and an integrator with a lag"
  import Modelica.Blocks;
  Blocks.Sources.Step step(height = 1);
  Blocks.Continuous.LimPID controller(k = 3, Ti = 1, Td = 0.2, yMax = 0.5, Nd = 10, Ni = 0.9);
  Blocks.Continuous.FirstOrder lag(T = 0.3, y_start = 0, initType = Modelica.Blocks.Types.Init.InitialOutput);
  Blocks.Continuous.Integrator integrator;
equation
  connect(step.y, controller.u_s);
  connect(integrator.y, controller.u_m);
  connect(controller.y, lag.u);
  connect(lag.y, integrator.u);
  annotation(experiment(StopTime = 8, Tolerance = 1e-9));
end LimitedControl;
