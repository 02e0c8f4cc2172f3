within Modelica.Blocks;
package Interfaces "Connectors of signals, and blocks by number of inputs and outputs"
  extends Modelica.Icons.InterfacesPackage;

  connector RealInput = input Real "Real input";
  connector RealOutput = output Real "Real output";
  connector BooleanInput = input Boolean "Boolean input";
  connector BooleanOutput = output Boolean "Boolean output";
  connector IntegerInput = input Integer "Integer input";
  connector IntegerOutput = output Integer "Integer output";
  connector RealVectorInput = input Real "Real input, used as an element of a vector";
  connector RealVectorOutput = output Real "Real output, used as an element of a vector";
  connector IntegerVectorInput = input Integer "Integer input, used as an element of a vector";
  connector BooleanVectorInput = input Boolean "Boolean input, used as an element of a vector";

  partial block BlockIcon "Base of blocks with real signals (name until version 3)"
    extends Modelica.Blocks.Icons.Block;
  end BlockIcon;

  partial block SO "One output"
    extends Modelica.Blocks.Icons.Block;
    RealOutput y "output";
  end SO;

  partial block MO "A vector of outputs"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer nout(min = 1) = 1 "number of outputs";
    RealOutput y[nout] "outputs";
  end MO;

  partial block SISO "One input, one output"
    extends Modelica.Blocks.Icons.Block;
    RealInput u "input";
    RealOutput y "output";
  end SISO;

  partial block SI2SO "Two inputs, one output"
    extends Modelica.Blocks.Icons.Block;
    RealInput u1 "first input";
    RealInput u2 "second input";
    RealOutput y "output";
  end SI2SO;

  partial block SIMO "One input, a vector of outputs"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer nout = 1 "number of outputs";
    RealInput u "input";
    RealOutput y[nout] "outputs";
  end SIMO;

  partial block MISO "A vector of inputs, one output"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer nin = 1 "number of inputs";
    RealInput u[nin] "inputs";
    RealOutput y "output";
  end MISO;

  partial block PartialRealMISO "A vector of inputs that grows with its connections, one output"
    parameter Integer significantDigits(min = 1) = 3 "digits of the value that an editor shows";
    parameter Integer nu(min = 0) = 0 "number of inputs"
      annotation(Dialog(connectorSizing = true), HideResult = true);
    RealVectorInput u[nu] "inputs";
    RealOutput y "output";
  end PartialRealMISO;

  partial block MIMO "A vector of inputs, a vector of outputs"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer nin = 1 "number of inputs";
    parameter Integer nout = 1 "number of outputs";
    RealInput u[nin] "inputs";
    RealOutput y[nout] "outputs";
  end MIMO;

  partial block MIMOs "As many inputs as outputs"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n = 1 "number of inputs and of outputs";
    RealInput u[n] "inputs";
    RealOutput y[n] "outputs";
  end MIMOs;

  partial block MI2MO "Two vectors of inputs, a vector of outputs"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n = 1 "size of each vector";
    RealInput u1[n] "first inputs";
    RealInput u2[n] "second inputs";
    RealOutput y[n] "outputs";
  end MI2MO;

  partial block SignalSource "A source: the base of what starts at a time above an offset"
    extends SO;
    parameter Real offset = 0 "added to the output";
    parameter SI.Time startTime = 0 "until here the output is the offset";
  end SignalSource;

  partial block SVcontrol "A controller of one variable"
    extends Modelica.Blocks.Icons.Block;
    RealInput u_s "set point";
    RealInput u_m "measurement";
    RealOutput y "actuator";
  end SVcontrol;

  partial block MVcontrol "A controller of several variables"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer nu_s = 1 "number of set points";
    parameter Integer nu_m = 1 "number of measurements";
    parameter Integer ny = 1 "number of actuators";
    RealInput u_s[nu_s] "set points";
    RealInput u_m[nu_m] "measurements";
    RealOutput y[ny] "actuators";
  end MVcontrol;

  partial block DiscreteBlock "A block that works at sampling instants"
    extends Modelica.Blocks.Icons.DiscreteBlock;
    parameter SI.Time samplePeriod(min = 100*Modelica.Constants.eps, start = 0.1) "time between samples";
    parameter SI.Time startTime = 0 "time of the first sample";
  protected
    output Boolean sampleTrigger "true at the sampling instants";
    output Boolean firstTrigger(start = false, fixed = true) "true from the first sample on";
  equation
    sampleTrigger = sample(startTime, samplePeriod);
    when sampleTrigger then
      firstTrigger = time <= startTime + samplePeriod/2;
    end when;
  end DiscreteBlock;

  partial block DiscreteSISO "One input, one output, sampled"
    extends DiscreteBlock;
    RealInput u "input";
    RealOutput y "output";
  end DiscreteSISO;

  partial block DiscreteMIMO "A vector of inputs, a vector of outputs, sampled"
    extends DiscreteBlock;
    parameter Integer nin = 1 "number of inputs";
    parameter Integer nout = 1 "number of outputs";
    RealInput u[nin] "inputs";
    RealOutput y[nout] "outputs";
  end DiscreteMIMO;

  partial block DiscreteMIMOs "As many inputs as outputs, sampled"
    parameter Integer n = 1 "number of inputs and of outputs";
    extends DiscreteBlock;
    RealInput u[n] "inputs";
    RealOutput y[n] "outputs";
  end DiscreteMIMOs;

  partial block BooleanSISO "One Boolean input, one Boolean output"
    extends Modelica.Blocks.Icons.BooleanBlock;
    BooleanInput u "input";
    BooleanOutput y "output";
  end BooleanSISO;

  partial block BooleanMIMOs "As many Boolean inputs as outputs"
    extends Modelica.Blocks.Icons.BooleanBlock;
    parameter Integer n = 1 "number of inputs and of outputs";
    BooleanInput u[n] "inputs";
    BooleanOutput y[n] "outputs";
  end BooleanMIMOs;

  partial block MI2BooleanMOs "Two vectors of real inputs, a vector of Boolean outputs"
    extends Modelica.Blocks.Icons.BooleanBlock;
    parameter Integer n = 1 "size of each vector";
    RealInput u1[n] "first inputs";
    RealInput u2[n] "second inputs";
    BooleanOutput y[n] "outputs";
  end MI2BooleanMOs;

  partial block SI2BooleanSO "Two Boolean inputs, one Boolean output"
    extends Modelica.Blocks.Icons.BooleanBlock;
    BooleanInput u1 "first input";
    BooleanInput u2 "second input";
    BooleanOutput y "output";
  end SI2BooleanSO;

  partial block BooleanSignalSource "A source of a Boolean signal"
    extends Modelica.Blocks.Icons.BooleanBlock;
    BooleanOutput y "output";
  end BooleanSignalSource;

  partial block IntegerSO "One integer output"
    extends Modelica.Blocks.Icons.IntegerBlock;
    IntegerOutput y "output";
  end IntegerSO;

  partial block IntegerMO "A vector of integer outputs"
    extends Modelica.Blocks.Icons.IntegerBlock;
    parameter Integer nout(min = 1) = 1 "number of outputs";
    IntegerOutput y[nout] "outputs";
  end IntegerMO;

  partial block IntegerSignalSource "A source of an integer signal"
    extends IntegerSO;
    parameter Integer offset = 0 "added to the output";
    parameter SI.Time startTime = 0 "until here the output is the offset";
  end IntegerSignalSource;

  partial block IntegerSIBooleanSO "One integer input, one Boolean output"
    extends Modelica.Blocks.Icons.BooleanBlock;
    IntegerInput u "input";
    BooleanOutput y "output";
  end IntegerSIBooleanSO;

  partial block IntegerMIBooleanMOs "As many integer inputs as Boolean outputs"
    extends Modelica.Blocks.Icons.BooleanBlock;
    parameter Integer n = 1 "number of inputs and of outputs";
    IntegerInput u[n] "inputs";
    BooleanOutput y[n] "outputs";
  end IntegerMIBooleanMOs;

  partial block PartialIntegerSISO "One integer input, one integer output"
    IntegerInput u "input";
    IntegerOutput y "output";
  end PartialIntegerSISO;

  partial block PartialIntegerMISO "Integer inputs that grow with their connections, one output"
    parameter Integer nu(min = 0) = 0 "number of inputs"
      annotation(Dialog(connectorSizing = true), HideResult = true);
    IntegerVectorInput u[nu] "inputs";
    IntegerOutput y "output";
  end PartialIntegerMISO;

  partial block partialBooleanSI "One Boolean input"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    BooleanInput u "input";
  end partialBooleanSI;

  partial block partialBooleanSO "One Boolean output"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    BooleanOutput y "output";
  end partialBooleanSO;

  partial block partialBooleanSISO "One Boolean input, one Boolean output"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    BooleanInput u "input";
    BooleanOutput y "output";
  end partialBooleanSISO;

  partial block partialBooleanSI2SO "Two Boolean inputs, one Boolean output"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    BooleanInput u1 "first input";
    BooleanInput u2 "second input";
    BooleanOutput y "output";
  end partialBooleanSI2SO;

  partial block partialBooleanSI3SO "Three Boolean inputs, one Boolean output"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    BooleanInput u1 "first input";
    BooleanInput u2 "second input";
    BooleanInput u3 "third input";
    BooleanOutput y "output";
  end partialBooleanSI3SO;

  partial block partialBooleanSource "A source of a Boolean signal"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    BooleanOutput y "output";
  end partialBooleanSource;

  partial block partialBooleanThresholdComparison "Comparison of an input with a threshold"
    parameter Real threshold = 0 "the input is compared with it";
    RealInput u "input";
    BooleanOutput y "output";
  end partialBooleanThresholdComparison;

  partial block partialBooleanComparison "Comparison of two inputs"
    RealInput u1 "first input";
    RealInput u2 "second input";
    BooleanOutput y "output";
  end partialBooleanComparison;

  partial block PartialBooleanSISO_small "One Boolean input, one Boolean output"
    BooleanInput u "input";
    BooleanOutput y "output";
  end PartialBooleanSISO_small;

  partial block PartialBooleanMISO "Boolean inputs that grow with their connections, one output"
    parameter Integer nu(min = 0) = 0 "number of inputs"
      annotation(Dialog(connectorSizing = true), HideResult = true);
    BooleanVectorInput u[nu] "inputs";
    BooleanOutput y "output";
  end PartialBooleanMISO;

  partial block PartialConversionBlock "One input, one output of another unit"
    RealInput u "input";
    RealOutput y "output";
  end PartialConversionBlock;
end Interfaces;
