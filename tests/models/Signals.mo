model Signals "Every source of a real signal"
  import Modelica.Blocks.Sources;
  Sources.Constant constant_(k = 3);
  Sources.Step step(height = 2, offset = 1, startTime = 0.5);
  Sources.Ramp ramp(height = 4, duration = 2, startTime = 0.5);
  Sources.Sine sine(amplitude = 2, f = 0.3, phase = 0.4, offset = 1, startTime = 0.2);
  Sources.Cosine cosine(f = 0.3);
  Sources.ExpSine expSine(f = 0.7, damping = 0.5);
  Sources.Exponentials exponentials(riseTime = 0.5, riseTimeConst = 0.2, fallTimeConst = 0.4, startTime = 0.1);
  Sources.Pulse pulse(amplitude = 2, width = 30, period = 0.5, offset = -1, startTime = 0.1);
  Sources.SawTooth sawTooth(amplitude = 2, period = 0.7, startTime = 0.1);
  Sources.Trapezoid trapezoid(amplitude = 2, rising = 0.1, width = 0.2, falling = 0.3, period = 0.8, nperiod = 2);
  Sources.ContinuousClock clock(offset = 0.5, startTime = 0.4);
  Modelica.Blocks.Continuous.Integrator pulses;
  Modelica.Blocks.Continuous.Integrator teeth;
  Modelica.Blocks.Continuous.Integrator trapezoids;
equation
  connect(pulse.y, pulses.u);
  connect(sawTooth.y, teeth.u);
  connect(trapezoid.y, trapezoids.u);
  annotation(experiment(StopTime = 2.15, Tolerance = 1e-9));
end Signals;
