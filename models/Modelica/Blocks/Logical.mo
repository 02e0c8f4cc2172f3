within Modelica.Blocks;
package Logical "Truth values, comparisons and switches"
  extends Modelica.Icons.Package;
  import Modelica.Blocks.Interfaces;

  block And "Both inputs"
    extends Interfaces.partialBooleanSI2SO;
  equation
    y = u1 and u2;
  end And;

  block Or "One of the inputs, or both"
    extends Interfaces.partialBooleanSI2SO;
  equation
    y = u1 or u2;
  end Or;

  block Xor "One of the inputs, not both"
    extends Interfaces.partialBooleanSI2SO;
  equation
    y = u1 <> u2;
  end Xor;

  block Nor "Neither of the inputs"
    extends Interfaces.partialBooleanSI2SO;
  equation
    y = not (u1 or u2);
  end Nor;

  block Nand "Not both inputs"
    extends Interfaces.partialBooleanSI2SO;
  equation
    y = not (u1 and u2);
  end Nand;

  block Not "Not the input"
    extends Interfaces.partialBooleanSISO;
  equation
    y = not u;
  end Not;

  block Pre "The input one step of an event iteration before: cuts a logical loop"
    parameter Boolean pre_u_start = false "first output";
    extends Interfaces.partialBooleanSISO;
  initial equation
    pre(u) = pre_u_start;
  equation
    y = pre(u);
  end Pre;

  block Edge "True where the input becomes true"
    parameter Boolean pre_u_start = false "input before the start";
    extends Interfaces.partialBooleanSISO;
  initial equation
    pre(u) = pre_u_start;
  equation
    y = edge(u);
  end Edge;

  block FallingEdge "True where the input becomes false"
    parameter Boolean pre_u_start = false "input before the start";
    extends Interfaces.partialBooleanSISO;
  protected
    Boolean not_u = not u "not the input";
  initial equation
    pre(not_u) = not pre_u_start;
  equation
    y = edge(not_u);
  end FallingEdge;

  block Change "True where the input changes"
    parameter Boolean pre_u_start = false "input before the start";
    extends Interfaces.partialBooleanSISO;
  initial equation
    pre(u) = pre_u_start;
  equation
    y = change(u);
  end Change;

  block GreaterThreshold "u > threshold"
    extends Interfaces.partialBooleanThresholdComparison;
  equation
    y = u > threshold;
  end GreaterThreshold;

  block GreaterEqualThreshold "u >= threshold"
    extends Interfaces.partialBooleanThresholdComparison;
  equation
    y = u >= threshold;
  end GreaterEqualThreshold;

  block LessThreshold "u < threshold"
    extends Interfaces.partialBooleanThresholdComparison;
  equation
    y = u < threshold;
  end LessThreshold;

  block LessEqualThreshold "u <= threshold"
    extends Interfaces.partialBooleanThresholdComparison;
  equation
    y = u <= threshold;
  end LessEqualThreshold;

  block Greater "u1 > u2"
    extends Interfaces.partialBooleanComparison;
  equation
    y = u1 > u2;
  end Greater;

  block GreaterEqual "u1 >= u2"
    extends Interfaces.partialBooleanComparison;
  equation
    y = u1 >= u2;
  end GreaterEqual;

  block Less "u1 < u2"
    extends Interfaces.partialBooleanComparison;
  equation
    y = u1 < u2;
  end Less;

  block LessEqual "u1 <= u2"
    extends Interfaces.partialBooleanComparison;
  equation
    y = u1 <= u2;
  end LessEqual;

  block ZeroCrossing "True where the input crosses zero, while enabled"
    extends Interfaces.partialBooleanSO;
    Interfaces.RealInput u "input";
    Interfaces.BooleanInput enable "whether crossings count";
  protected
    Boolean above "whether the input is positive";
  initial equation
    pre(above) = false;
    pre(enable) = false;
  equation
    above = enable and u > 0;
    y = change(above) and not change(enable);
  end ZeroCrossing;

  block LogicalSwitch "One of two Boolean inputs"
    extends Interfaces.partialBooleanSI3SO;
  equation
    y = if u2 then u1 else u3;
  end LogicalSwitch;

  block Switch "One of two real inputs"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    Interfaces.RealInput u1 "output if the second input is true";
    Interfaces.BooleanInput u2 "which input is taken";
    Interfaces.RealInput u3 "output if the second input is false";
    Interfaces.RealOutput y "output";
  equation
    y = if u2 then u1 else u3;
  end Switch;

  block Hysteresis "True above one limit until below another"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    parameter Real uLow(start = 0) "below it the output becomes false";
    parameter Real uHigh(start = 1) "above it the output becomes true";
    parameter Boolean pre_y_start = false "output before the start";
    Interfaces.RealInput u "input";
    Interfaces.BooleanOutput y "output";
  initial equation
    pre(y) = pre_y_start;
  equation
    assert(uHigh > uLow, "uHigh has to be greater than uLow");
    y = u > uHigh or pre(y) and u >= uLow;
  end Hysteresis;

  block OnOffController "On below the reference, off above, within a band"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    Interfaces.RealInput reference "what the input is to be";
    Interfaces.RealInput u "input";
    Interfaces.BooleanOutput y "whether it is on";
    parameter Real bandwidth(start = 0.1) "width of the band around the reference";
    parameter Boolean pre_y_start = false "output before the start";
  initial equation
    pre(y) = pre_y_start;
  equation
    y = u < reference - bandwidth/2 or pre(y) and u <= reference + bandwidth/2;
  end OnOffController;

  block Timer "How long the input has been true"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    Interfaces.BooleanInput u "input";
    Interfaces.RealOutput y "time since it became true; zero while it is false";
  protected
    discrete SI.Time entryTime "when the input became true";
  initial equation
    pre(entryTime) = time;
  equation
    when u then
      entryTime = time;
    end when;
    y = if u then time - entryTime else 0;
  end Timer;

  block LogicalDelay "Delayed edges"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    parameter SI.Time delayTime(final min = 0) = 0 "delay";
    Interfaces.BooleanInput u "input";
    Interfaces.BooleanOutput y1 "true at once, false after the delay";
    Interfaces.BooleanOutput y2 "true after the delay, false at once";
  protected
    discrete SI.Time tSwitch "time of the last edge";
  initial equation
    tSwitch = time - 2*delayTime;
  equation
    when change(u) then
      tSwitch = time;
    end when;
    y1 = u or time < tSwitch + delayTime;
    y2 = u and time >= tSwitch + delayTime;
  end LogicalDelay;

  block RSFlipFlop "Store of one bit"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    parameter Boolean Qini = false "output before the start";
    Interfaces.BooleanInput S "sets";
    Interfaces.BooleanInput R "resets";
    Interfaces.BooleanOutput Q "output";
    Interfaces.BooleanOutput QI "not the output, unless set and reset are both true";
  initial equation
    pre(Q) = Qini;
  equation
    Q = not R and (S or pre(Q));
    QI = not S and not Q;
  end RSFlipFlop;

  block TriggeredTrapezoid "A trapezoid that rises while the input is true"
    extends Modelica.Blocks.Icons.PartialBooleanBlock;
    parameter Real amplitude = 1 "height";
    parameter SI.Time rising(final min = 0) = 0 "time of a whole rise";
    parameter SI.Time falling(final min = 0) = rising "time of a whole fall";
    parameter Real offset = 0 "added to the output";
    Interfaces.BooleanInput u "input";
    Interfaces.RealOutput y "output";
  protected
    discrete Real endValue "where the output goes to";
    discrete Real rate "slope";
    discrete SI.Time T "when it is there";
  equation
    when {initial(), change(u)} then
      endValue = if u then offset + amplitude else offset;
      rate = if u and rising > 0 then amplitude/rising
        elseif not u and falling > 0 then -amplitude/falling
        else 0;
      T = if rate == 0 or initial() and not u then time
        elseif initial() then time + rising
        else time + (endValue - pre(y))/rate;
    end when;
    y = if time < T then endValue - (T - time)*rate else endValue;
  end TriggeredTrapezoid;

  block AssertCondition "An error where the input is false"
    extends Interfaces.partialBooleanSI;
    parameter String message = "" "text of the error";
    parameter AssertionLevel assertionLevel = AssertionLevel.error "error or warning";
  equation
    if assertionLevel == AssertionLevel.error then
      assert(u, message);
    else
      assert(u, message, AssertionLevel.warning);
    end if;
  end AssertCondition;

  block TerminateSimulation "The end of the simulation where a condition becomes true"
    Interfaces.BooleanOutput condition = false "the condition, its binding";
    parameter String terminationText = "the condition of the end is true" "text of the end";
  equation
    when condition then
      terminate(terminationText);
    end when;
  end TerminateSimulation;
end Logical;
