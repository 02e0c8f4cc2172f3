model Sampled "Sampled systems"
  import Modelica.Blocks;
  Blocks.Sources.ContinuousClock clock;
  Blocks.Discrete.Sampler sampler(samplePeriod = 0.1);
  Blocks.Discrete.ZeroOrderHold hold(samplePeriod = 0.1);
  Blocks.Discrete.UnitDelay delay_(samplePeriod = 0.1);
  Blocks.Discrete.TransferFunction transferFunction(samplePeriod = 0.1, b = {1}, a = {1, -0.5});
  Blocks.Discrete.TriggeredSampler triggered;
  Blocks.Sources.BooleanStep trigger(startTime = 0.42);
  Blocks.Logical.Timer timer;
  Blocks.Logical.Hysteresis hysteresis(uLow = 0.2, uHigh = 0.6);
  Blocks.Math.BooleanToInteger above;
equation
  connect(clock.y, sampler.u);
  connect(clock.y, hold.u);
  connect(clock.y, delay_.u);
  connect(clock.y, transferFunction.u);
  connect(clock.y, triggered.u);
  connect(trigger.y, triggered.trigger);
  connect(trigger.y, timer.u);
  connect(clock.y, hysteresis.u);
  connect(hysteresis.y, above.u);
  annotation(experiment(StopTime = 0.75));
end Sampled;
