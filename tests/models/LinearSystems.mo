model LinearSystems "Answers of linear systems to a step"
  import Modelica.Blocks.Continuous;
  import Modelica.Blocks.Types.Init;
  Modelica.Blocks.Sources.Step step;
  Continuous.FirstOrder firstOrder(k = 2, T = 0.5, initType = Init.InitialState);
  Continuous.SecondOrder secondOrder(k = 2, w = 3, D = 0.4, initType = Init.InitialState);
  Continuous.PI pi(k = 2, T = 0.5, initType = Init.InitialState);
  Continuous.PID pid(k = 2, Ti = 0.5, Td = 0.1, Nd = 5);
  Continuous.Derivative derivative(k = 2, T = 0.5, initType = Init.InitialState);
  Continuous.TransferFunction transferFunction(
    b = {1, 2}, a = {1, 3, 5}, initType = Init.InitialState);
  Continuous.StateSpace stateSpace(
    A = [0, 1; -5, -3], B = [0; 1], C = [2, 1], initType = Init.InitialState);
  Continuous.CriticalDamping criticalDamping(n = 3, f = 0.5, normalized = false, initType = Init.InitialState);
equation
  connect(step.y, firstOrder.u);
  connect(step.y, secondOrder.u);
  connect(step.y, pi.u);
  connect(step.y, pid.u);
  connect(step.y, derivative.u);
  connect(step.y, transferFunction.u);
  connect(step.y, stateSpace.u[1]);
  connect(step.y, criticalDamping.u);
  annotation(experiment(StopTime = 1, Tolerance = 1e-10));
end LinearSystems;
