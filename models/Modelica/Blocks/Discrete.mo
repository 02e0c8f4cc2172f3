within Modelica.Blocks;
package Discrete "Sampled systems"
  extends Modelica.Icons.Package;
  import Modelica.Blocks.Interfaces;

  block Sampler "The input at the sampling instants"
    extends Interfaces.DiscreteSISO(y(start = 0, fixed = true));
  equation
    when {sampleTrigger, initial()} then
      y = u;
    end when;
  end Sampler;

  block ZeroOrderHold "The input at the last sampling instant"
    extends Interfaces.DiscreteSISO;
    output Real ySample(start = 0, fixed = true) "sampled input";
  equation
    when {sampleTrigger, initial()} then
      ySample = u;
    end when;
    y = pre(ySample);
  end ZeroOrderHold;

  block FirstOrderHold "The line through the last two samples"
    extends Interfaces.DiscreteSISO;
  protected
    discrete SI.Time tSample "time of the last sample";
    discrete Real uSample "last sample";
    discrete Real slope "slope through the last two samples";
  initial equation
    pre(tSample) = time;
    pre(uSample) = u;
    pre(slope) = 0;
  equation
    when sampleTrigger then
      tSample = time;
      uSample = u;
      slope = if firstTrigger then 0 else (uSample - pre(uSample))/samplePeriod;
    end when;
    y = pre(uSample) + pre(slope)*(time - tSample);
  end FirstOrderHold;

  block UnitDelay "The sample before"
    parameter Real y_start = 0 "first output";
    extends Interfaces.DiscreteSISO(y(start = y_start));
  initial equation
    y = y_start;
  equation
    when sampleTrigger then
      y = pre(u);
    end when;
  end UnitDelay;

  block TransferFunction "b(z)/a(z)"
    parameter Real b[:] = {1} "coefficients of the numerator, highest power first";
    parameter Real a[:] = {1} "coefficients of the denominator, highest power first";
    extends Interfaces.DiscreteSISO;
    output Real x[size(a, 1) - 1](each start = 0, each fixed = true) "states: the samples before";
  protected
    parameter Integer na = size(a, 1) "coefficients of the denominator";
    discrete Real x1(start = 0, fixed = true) "new state";
    discrete Real xext[na](each start = 0, each fixed = true) "new and old states";
  equation
    when sampleTrigger then
      x1 = (u - a[2:na]*pre(x))/a[1];
      xext = cat(1, {x1}, pre(x));
      x = xext[1:na - 1];
      y = cat(1, zeros(size(a, 1) - size(b, 1)), b)*xext;
    end when;
  end TransferFunction;

  block StateSpace "x = A pre(x) + B u, y = C pre(x) + D u"
    parameter Real A[:, size(A, 1)] = [1, 0; 0, 1] "states to states";
    parameter Real B[size(A, 1), :] = [1; 1] "inputs to states";
    parameter Real C[:, size(A, 1)] = [1, 1] "states to outputs";
    parameter Real D[size(C, 1), size(B, 2)] = zeros(size(C, 1), size(B, 2)) "inputs to outputs";
    extends Interfaces.DiscreteMIMO(final nin = size(B, 2), final nout = size(C, 1));
    output Real x[size(A, 1)] "states";
  equation
    when sampleTrigger then
      x = A*pre(x) + B*u;
      y = C*pre(x) + D*u;
    end when;
  end StateSpace;

  block TriggeredSampler "The input where the trigger becomes true"
    extends Modelica.Blocks.Icons.DiscreteBlock;
    parameter Real y_start = 0 "first output";
    Interfaces.RealInput u "input";
    Interfaces.RealOutput y(start = y_start, fixed = true) "output";
    Interfaces.BooleanInput trigger "trigger";
  equation
    when trigger then
      y = u;
    end when;
  end TriggeredSampler;

  block TriggeredMax "The greatest absolute value at the triggers so far"
    extends Modelica.Blocks.Icons.DiscreteBlock;
    Interfaces.RealInput u "input";
    Interfaces.RealOutput y(start = 0, fixed = true) "output";
    Interfaces.BooleanInput trigger "trigger";
  equation
    when trigger then
      y = max(pre(y), abs(u));
    end when;
  end TriggeredMax;
end Discrete;
