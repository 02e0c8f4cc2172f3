within Modelica.Blocks;
package Sources "Sources of signals"
  extends Modelica.Icons.SourcesPackage;
  import Modelica.Blocks.Interfaces;

  block RealExpression "A real output that is an expression"
    Interfaces.RealOutput y = 0.0 "output; its binding is the expression";
  end RealExpression;

  block IntegerExpression "An integer output that is an expression"
    Interfaces.IntegerOutput y = 0 "output; its binding is the expression";
  end IntegerExpression;

  block BooleanExpression "A Boolean output that is an expression"
    Interfaces.BooleanOutput y = false "output; its binding is the expression";
  end BooleanExpression;

  block ContinuousClock "The time that has passed since the start time"
    extends Interfaces.SignalSource;
  equation
    y = offset + (if time < startTime then 0 else time - startTime);
  end ContinuousClock;

  block Clock = ContinuousClock "Name of the clock until version 3";

  block Constant "A constant"
    parameter Real k(start = 1) "output";
    extends Interfaces.SO;
  equation
    y = k;
  end Constant;

  block Step "A step"
    parameter Real height = 1 "height of the step";
    extends Interfaces.SignalSource;
  equation
    y = offset + (if time < startTime then 0 else height);
  end Step;

  block Ramp "A ramp; a step if its duration is zero"
    parameter Real height = 1 "height at the end";
    parameter SI.Time duration(min = 0.0, start = 2) "how long the output rises";
    extends Interfaces.SignalSource;
  equation
    y = offset + (if time < startTime then 0
      elseif time < startTime + duration then height*(time - startTime)/duration
      else height);
  end Ramp;

  block Sine "A sine"
    parameter Real amplitude = 1 "amplitude";
    parameter SI.Frequency f = freqHz "frequency";
    parameter SI.Frequency freqHz = 1 "frequency, by its name until version 3";
    parameter SI.Angle phase = 0 "phase at the start time";
    parameter Boolean continuous = false "before the start time the output keeps its first value";
    extends Interfaces.SignalSource;
  equation
    y = offset + (if time < startTime then (if continuous then amplitude*sin(phase) else 0)
      else amplitude*sin(2*Modelica.Constants.pi*f*(time - startTime) + phase));
  end Sine;

  block Cosine "A cosine"
    parameter Real amplitude = 1 "amplitude";
    parameter SI.Frequency f = freqHz "frequency";
    parameter SI.Frequency freqHz = 1 "frequency, by its name until version 3";
    parameter SI.Angle phase = 0 "phase at the start time";
    parameter Boolean continuous = false "before the start time the output keeps its first value";
    extends Interfaces.SignalSource;
  equation
    y = offset + (if time < startTime then (if continuous then amplitude*cos(phase) else 0)
      else amplitude*cos(2*Modelica.Constants.pi*f*(time - startTime) + phase));
  end Cosine;

  block Sinc "sin(x)/x"
    parameter Real amplitude = 1 "amplitude";
    parameter SI.Frequency f(start = 1) "frequency of the sine";
    parameter Boolean continuous = false "before the start time the output is the amplitude";
    extends Interfaces.SignalSource;
  protected
    SI.Angle x = 2*Modelica.Constants.pi*f*(time - startTime) "argument";
  equation
    y = offset + (if time < startTime then (if continuous then amplitude else 0)
      else amplitude*(if noEvent(abs(x) < 1e-8) then 1 else sin(x)/x));
  end Sinc;

  block ExpSine "A sine that dies away"
    parameter Real amplitude = 1 "amplitude at the start time";
    parameter SI.Frequency f = freqHz "frequency";
    parameter SI.Frequency freqHz = 2 "frequency, by its name until version 3";
    parameter SI.Angle phase = 0 "phase at the start time";
    parameter SI.Damping damping(start = 1) "damping";
    extends Interfaces.SignalSource;
  equation
    y = offset + (if time < startTime then 0
      else amplitude*exp(-damping*(time - startTime))
        *sin(2*Modelica.Constants.pi*f*(time - startTime) + phase));
  end ExpSine;

  block Exponentials "Exponential rise and fall"
    parameter Real outMax = 1 "output after an endless rise";
    parameter SI.Time riseTime(min = 0, start = 0.5) "how long the output rises";
    parameter SI.Time riseTimeConst(min = Modelica.Constants.small) = 0.1 "time constant of the rise";
    parameter SI.Time fallTimeConst(min = Modelica.Constants.small) = riseTimeConst "time constant of the fall";
    extends Interfaces.SignalSource;
  protected
    final parameter Real top = outMax*(1 - exp(-riseTime/riseTimeConst)) "output at the end of the rise";
  equation
    y = offset + (if time < startTime then 0
      elseif time < startTime + riseTime then outMax*(1 - exp(-(time - startTime)/riseTimeConst))
      else top*exp(-(time - startTime - riseTime)/fallTimeConst));
  end Exponentials;

  partial block Periodic "A signal that repeats"
    parameter SI.Time period(final min = Modelica.Constants.small, start = 1) "time of one period";
    parameter Integer nperiod = -1 "number of periods; less than zero: without end";
    extends Interfaces.SignalSource;
  protected
    discrete SI.Time T_start "start of the period";
    discrete Integer count "number of the period, the first is 0";
    Boolean active "whether the signal is there";
  initial equation
    count = integer(floor((time - startTime)/period));
    T_start = startTime + count*period;
  equation
    when sample(startTime, period) then
      count = integer(floor((time - startTime)/period + 0.5));
      T_start = time;
    end when;
    active = time >= startTime and (nperiod < 0 or count < nperiod);
  end Periodic;

  block Pulse "Rectangular pulses"
    parameter Real amplitude = 1 "height of a pulse";
    parameter Real width(final min = Modelica.Constants.small, final max = 100) = 50
      "width of a pulse in percent of the period";
    extends Periodic;
  equation
    y = offset + (if active and time < T_start + period*width/100 then amplitude else 0);
  end Pulse;

  block SawTooth "Saw teeth"
    parameter Real amplitude = 1 "height of a tooth";
    extends Periodic;
  equation
    y = offset + (if active then amplitude*(time - T_start)/period else 0);
  end SawTooth;

  block Trapezoid "Trapezoids"
    parameter Real amplitude = 1 "height of a trapezoid";
    parameter SI.Time rising(final min = 0) = 0 "how long it rises";
    parameter SI.Time width(final min = 0) = 0.5 "how long it stays";
    parameter SI.Time falling(final min = 0) = 0 "how long it falls";
    extends Periodic;
  protected
    SI.Time t = time - T_start "time in the period";
  equation
    y = offset + (if not active then 0
      elseif t < rising then amplitude*t/rising
      elseif t < rising + width then amplitude
      elseif t < rising + width + falling then amplitude*(rising + width + falling - t)/falling
      else 0);
  end Trapezoid;

  block BooleanConstant "A Boolean constant"
    parameter Boolean k = true "output";
    extends Interfaces.partialBooleanSource;
  equation
    y = k;
  end BooleanConstant;

  block BooleanStep "A change at a time"
    parameter SI.Time startTime = 0 "time of the change";
    parameter Boolean startValue = false "output before";
    extends Interfaces.partialBooleanSource;
  equation
    y = if time >= startTime then not startValue else startValue;
  end BooleanStep;

  block BooleanPulse "Boolean pulses"
    parameter Real width(final min = Modelica.Constants.small, final max = 100) = 50
      "width of a pulse in percent of the period";
    parameter SI.Time period(final min = Modelica.Constants.small, start = 1) "time of one period";
    parameter SI.Time startTime = 0 "time of the first pulse";
    extends Interfaces.partialBooleanSource;
  protected
    discrete SI.Time pulseStart "start of the pulse";
  initial equation
    pulseStart = startTime + period*floor((time - startTime)/period);
  equation
    when sample(startTime, period) then
      pulseStart = time;
    end when;
    y = time >= startTime and time < pulseStart + period*width/100;
  end BooleanPulse;

  block SampleTrigger "True at sampling instants only"
    parameter SI.Time period(final min = Modelica.Constants.small, start = 0.01) "time between samples";
    parameter SI.Time startTime = 0 "time of the first sample";
    extends Interfaces.partialBooleanSource;
  equation
    y = sample(startTime, period);
  end SampleTrigger;

  block IntegerConstant "An integer constant"
    parameter Integer k(start = 1) "output";
    extends Interfaces.IntegerSO;
  equation
    y = k;
  end IntegerConstant;

  block IntegerStep "An integer step"
    parameter Integer height = 1 "height of the step";
    extends Interfaces.IntegerSignalSource;
  equation
    y = offset + (if time < startTime then 0 else height);
  end IntegerStep;
end Sources;
