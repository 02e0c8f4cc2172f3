within Modelica.Electrical.Analog;
package Sources "Sources of voltage and current"
  extends Modelica.Icons.SourcesPackage;

  model SignalVoltage "Voltage that is an input"
    extends Icons.VoltageSource;
    Interfaces.PositivePin p "positive pin";
    Interfaces.NegativePin n "negative pin";
    Modelica.Blocks.Interfaces.RealInput v(unit = "V") "voltage from the positive to the negative pin";
    SI.Current i "current from the positive to the negative pin";
  equation
    v = p.v - n.v;
    i = p.i;
    p.i + n.i = 0;
  end SignalVoltage;

  model SignalCurrent "Current that is an input"
    extends Icons.CurrentSource;
    Interfaces.PositivePin p "positive pin";
    Interfaces.NegativePin n "negative pin";
    Modelica.Blocks.Interfaces.RealInput i(unit = "A") "current from the positive to the negative pin";
    SI.Voltage v "voltage from the positive to the negative pin";
  equation
    v = p.v - n.v;
    i = p.i;
    p.i + n.i = 0;
  end SignalCurrent;

  model ConstantVoltage "Constant voltage"
    parameter SI.Voltage V(start = 1) "voltage";
    extends Interfaces.OnePort;
    extends Icons.VoltageSource;
  equation
    v = V;
  end ConstantVoltage;

  model ConstantCurrent "Constant current"
    parameter SI.Current I(start = 1) "current";
    extends Interfaces.OnePort;
    extends Icons.CurrentSource;
  equation
    i = I;
  end ConstantCurrent;

  model StepVoltage "Step: voltage"
    parameter SI.Voltage V(start = 1) "height";
    extends Interfaces.VoltageSource(redeclare Modelica.Blocks.Sources.Step signalSource(
      final height = V));
  end StepVoltage;

  model RampVoltage "Ramp: voltage"
    parameter SI.Voltage V(start = 1) "height";
    parameter SI.Time duration(min = Modelica.Constants.small, start = 2) "how long it rises";
    extends Interfaces.VoltageSource(redeclare Modelica.Blocks.Sources.Ramp signalSource(
      final height = V, final duration = duration));
  end RampVoltage;

  model SineVoltage "Sine: voltage"
    parameter SI.Voltage V(start = 1) "amplitude";
    parameter SI.Angle phase = 0 "phase at the start time";
    parameter SI.Frequency f = freqHz "frequency";
    parameter SI.Frequency freqHz = 1 "frequency, by its name until version 3";
    extends Interfaces.VoltageSource(redeclare Modelica.Blocks.Sources.Sine signalSource(
      final amplitude = V, final f = f, final phase = phase));
  end SineVoltage;

  model CosineVoltage "Cosine: voltage"
    parameter SI.Voltage V(start = 1) "amplitude";
    parameter SI.Angle phase = 0 "phase at the start time";
    parameter SI.Frequency f = freqHz "frequency";
    parameter SI.Frequency freqHz = 1 "frequency, by its name until version 3";
    extends Interfaces.VoltageSource(redeclare Modelica.Blocks.Sources.Cosine signalSource(
      final amplitude = V, final f = f, final phase = phase));
  end CosineVoltage;

  model ExpSineVoltage "Sine that dies away: voltage"
    parameter SI.Voltage V(start = 1) "amplitude at the start time";
    parameter SI.Frequency f = freqHz "frequency";
    parameter SI.Frequency freqHz = 2 "frequency, by its name until version 3";
    parameter SI.Angle phase = 0 "phase at the start time";
    parameter SI.Damping damping(start = 1) "damping";
    extends Interfaces.VoltageSource(redeclare Modelica.Blocks.Sources.ExpSine signalSource(
      final amplitude = V, final f = f, final phase = phase, final damping = damping));
  end ExpSineVoltage;

  model ExponentialsVoltage "Exponential rise and fall: voltage"
    parameter Real vMax(start = 1) "limit of an endless rise";
    parameter SI.Time riseTime(min = 0, start = 0.5) "how long it rises";
    parameter SI.Time riseTimeConst(min = Modelica.Constants.small, start = 0.1) "time constant of the rise";
    parameter SI.Time fallTimeConst(min = Modelica.Constants.small, start = riseTimeConst) "time constant of the fall";
    extends Interfaces.VoltageSource(redeclare Modelica.Blocks.Sources.Exponentials signalSource(
      final outMax = vMax, final riseTime = riseTime, final riseTimeConst = riseTimeConst, final fallTimeConst = fallTimeConst));
  end ExponentialsVoltage;

  model PulseVoltage "Rectangular pulses: voltage"
    parameter SI.Voltage V(start = 1) "height of a pulse";
    parameter Real width(final min = Modelica.Constants.small, final max = 100, start = 50) "width of a pulse in percent of the period";
    parameter SI.Time period(final min = Modelica.Constants.small, start = 1) "time of one period";
    extends Interfaces.VoltageSource(redeclare Modelica.Blocks.Sources.Pulse signalSource(
      final amplitude = V, final width = width, final period = period));
  end PulseVoltage;

  model SawToothVoltage "Saw teeth: voltage"
    parameter SI.Voltage V(start = 1) "height of a tooth";
    parameter SI.Time period(start = 1) "time of one period";
    extends Interfaces.VoltageSource(redeclare Modelica.Blocks.Sources.SawTooth signalSource(
      final amplitude = V, final period = period));
  end SawToothVoltage;

  model TrapezoidVoltage "Trapezoids: voltage"
    parameter SI.Voltage V(start = 1) "height of a trapezoid";
    parameter SI.Time rising(final min = 0, start = 0) "how long it rises";
    parameter SI.Time width(final min = 0, start = 0.5) "how long it stays";
    parameter SI.Time falling(final min = 0, start = 0) "how long it falls";
    parameter SI.Time period(final min = Modelica.Constants.small, start = 1) "time of one period";
    parameter Integer nperiod(start = -1) "number of periods; less than zero: without end";
    extends Interfaces.VoltageSource(redeclare Modelica.Blocks.Sources.Trapezoid signalSource(
      final amplitude = V, final rising = rising, final width = width, final falling = falling, final period = period, final nperiod = nperiod));
  end TrapezoidVoltage;

  model TableVoltage "Straight lines between points over time: voltage"
    parameter Real table[:, :] = [0, 0; 1, 1; 2, 4] "points: times and values";
    extends Interfaces.VoltageSource(redeclare Modelica.Blocks.Sources.TimeTable signalSource(
      final table = table));
  end TableVoltage;

  model StepCurrent "Step: current"
    parameter SI.Current I(start = 1) "height";
    extends Interfaces.CurrentSource(redeclare Modelica.Blocks.Sources.Step signalSource(
      final height = I));
  end StepCurrent;

  model RampCurrent "Ramp: current"
    parameter SI.Current I(start = 1) "height";
    parameter SI.Time duration(min = Modelica.Constants.small, start = 2) "how long it rises";
    extends Interfaces.CurrentSource(redeclare Modelica.Blocks.Sources.Ramp signalSource(
      final height = I, final duration = duration));
  end RampCurrent;

  model SineCurrent "Sine: current"
    parameter SI.Current I(start = 1) "amplitude";
    parameter SI.Angle phase = 0 "phase at the start time";
    parameter SI.Frequency f = freqHz "frequency";
    parameter SI.Frequency freqHz = 1 "frequency, by its name until version 3";
    extends Interfaces.CurrentSource(redeclare Modelica.Blocks.Sources.Sine signalSource(
      final amplitude = I, final f = f, final phase = phase));
  end SineCurrent;

  model CosineCurrent "Cosine: current"
    parameter SI.Current I(start = 1) "amplitude";
    parameter SI.Angle phase = 0 "phase at the start time";
    parameter SI.Frequency f = freqHz "frequency";
    parameter SI.Frequency freqHz = 1 "frequency, by its name until version 3";
    extends Interfaces.CurrentSource(redeclare Modelica.Blocks.Sources.Cosine signalSource(
      final amplitude = I, final f = f, final phase = phase));
  end CosineCurrent;

  model ExpSineCurrent "Sine that dies away: current"
    parameter SI.Current I(start = 1) "amplitude at the start time";
    parameter SI.Frequency f = freqHz "frequency";
    parameter SI.Frequency freqHz = 2 "frequency, by its name until version 3";
    parameter SI.Angle phase = 0 "phase at the start time";
    parameter SI.Damping damping(start = 1) "damping";
    extends Interfaces.CurrentSource(redeclare Modelica.Blocks.Sources.ExpSine signalSource(
      final amplitude = I, final f = f, final phase = phase, final damping = damping));
  end ExpSineCurrent;

  model ExponentialsCurrent "Exponential rise and fall: current"
    parameter Real iMax(start = 1) "limit of an endless rise";
    parameter SI.Time riseTime(min = 0, start = 0.5) "how long it rises";
    parameter SI.Time riseTimeConst(min = Modelica.Constants.small, start = 0.1) "time constant of the rise";
    parameter SI.Time fallTimeConst(min = Modelica.Constants.small, start = riseTimeConst) "time constant of the fall";
    extends Interfaces.CurrentSource(redeclare Modelica.Blocks.Sources.Exponentials signalSource(
      final outMax = iMax, final riseTime = riseTime, final riseTimeConst = riseTimeConst, final fallTimeConst = fallTimeConst));
  end ExponentialsCurrent;

  model PulseCurrent "Rectangular pulses: current"
    parameter SI.Current I(start = 1) "height of a pulse";
    parameter Real width(final min = Modelica.Constants.small, final max = 100, start = 50) "width of a pulse in percent of the period";
    parameter SI.Time period(final min = Modelica.Constants.small, start = 1) "time of one period";
    extends Interfaces.CurrentSource(redeclare Modelica.Blocks.Sources.Pulse signalSource(
      final amplitude = I, final width = width, final period = period));
  end PulseCurrent;

  model SawToothCurrent "Saw teeth: current"
    parameter SI.Current I(start = 1) "height of a tooth";
    parameter SI.Time period(start = 1) "time of one period";
    extends Interfaces.CurrentSource(redeclare Modelica.Blocks.Sources.SawTooth signalSource(
      final amplitude = I, final period = period));
  end SawToothCurrent;

  model TrapezoidCurrent "Trapezoids: current"
    parameter SI.Current I(start = 1) "height of a trapezoid";
    parameter SI.Time rising(final min = 0, start = 0) "how long it rises";
    parameter SI.Time width(final min = 0, start = 0.5) "how long it stays";
    parameter SI.Time falling(final min = 0, start = 0) "how long it falls";
    parameter SI.Time period(final min = Modelica.Constants.small, start = 1) "time of one period";
    parameter Integer nperiod(start = -1) "number of periods; less than zero: without end";
    extends Interfaces.CurrentSource(redeclare Modelica.Blocks.Sources.Trapezoid signalSource(
      final amplitude = I, final rising = rising, final width = width, final falling = falling, final period = period, final nperiod = nperiod));
  end TrapezoidCurrent;

  model TableCurrent "Straight lines between points over time: current"
    parameter Real table[:, :] = [0, 0; 1, 1; 2, 4] "points: times and values";
    extends Interfaces.CurrentSource(redeclare Modelica.Blocks.Sources.TimeTable signalSource(
      final table = table));
  end TableCurrent;

  model SupplyVoltage "Two voltages around a common pin"
    parameter SI.Voltage Vps = +15 "voltage of the positive supply";
    parameter SI.Voltage Vns = -15 "voltage of the negative supply";
    Interfaces.PositivePin pin_p "positive supply";
    Interfaces.NegativePin pin_n "negative supply";
    Interfaces.NegativePin ground "common pin";
    ConstantVoltage positiveSupply(final V = Vps) "from the common pin to the positive supply";
    ConstantVoltage negativeSupply(final V = -Vns) "from the negative supply to the common pin";
  equation
    connect(positiveSupply.p, pin_p);
    connect(positiveSupply.n, ground);
    connect(negativeSupply.p, ground);
    connect(negativeSupply.n, pin_n);
  end SupplyVoltage;
end Sources;
