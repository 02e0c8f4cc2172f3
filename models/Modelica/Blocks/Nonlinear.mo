within Modelica.Blocks;
package Nonlinear "Limits, dead zones and delays"
  extends Modelica.Icons.Package;
  import Modelica.Blocks.Interfaces;

  block Limiter "The input between two limits"
    parameter Real uMax(start = 1) "upper limit";
    parameter Real uMin = -uMax "lower limit";
    parameter Boolean strict = false "reaching a limit is no event";
    parameter Types.LimiterHomotopy homotopyType = Modelica.Blocks.Types.LimiterHomotopy.Linear
      "simplified initial problem";
    parameter Boolean limitsAtInit = true "not used, kept for models of version 3";
    extends Interfaces.SISO;
  protected
    Real simplifiedExpr "output in the simplified initial problem";
    Real limited "output";
  equation
    assert(uMax >= uMin, "uMax has to be at least uMin");
    simplifiedExpr = if homotopyType == Types.LimiterHomotopy.UpperLimit then uMax
      elseif homotopyType == Types.LimiterHomotopy.LowerLimit then uMin
      else u;
    limited = if strict then smooth(0, noEvent(if u > uMax then uMax elseif u < uMin then uMin else u))
      else smooth(0, if u > uMax then uMax elseif u < uMin then uMin else u);
    y = if homotopyType == Types.LimiterHomotopy.NoHomotopy then limited
      else homotopy(actual = limited, simplified = simplifiedExpr);
  end Limiter;

  block VariableLimiter "The input between two other inputs"
    extends Interfaces.SISO;
    parameter Boolean strict = false "reaching a limit is no event";
    parameter Types.VariableLimiterHomotopy homotopyType = Modelica.Blocks.Types.VariableLimiterHomotopy.Linear
      "simplified initial problem";
    parameter Real ySimplified = 0 "output in the simplified initial problem, if fixed";
    Interfaces.RealInput limit1 "upper limit";
    Interfaces.RealInput limit2 "lower limit";
  protected
    Real limited "output";
  equation
    limited = if strict then smooth(0, noEvent(if u > limit1 then limit1 elseif u < limit2 then limit2 else u))
      else smooth(0, if u > limit1 then limit1 elseif u < limit2 then limit2 else u);
    y = if homotopyType == Types.VariableLimiterHomotopy.NoHomotopy then limited
      else homotopy(actual = limited,
        simplified = if homotopyType == Types.VariableLimiterHomotopy.Fixed then ySimplified else u);
  end VariableLimiter;

  block SlewRateLimiter "The input with a limited slope"
    extends Interfaces.SISO;
    parameter Real Rising(min = Modelica.Constants.small) = 1 "greatest slope";
    parameter Real Falling(max = -Modelica.Constants.small) = -Rising "smallest slope";
    parameter SI.Time Td(min = Modelica.Constants.small) = 0.001 "time constant of the approach to the input";
    parameter Modelica.Blocks.Types.Init initType = Modelica.Blocks.Types.Init.SteadyState "how it starts";
    parameter Real y_start = 0 "output at the start";
    parameter Boolean strict = false "reaching a limit is no event";
  protected
    Real val = (u - y)/Td "slope without limits";
  initial equation
    if initType == Modelica.Blocks.Types.Init.SteadyState then
      y = u;
    elseif initType == Modelica.Blocks.Types.Init.InitialState
        or initType == Modelica.Blocks.Types.Init.InitialOutput then
      y = y_start;
    end if;
  equation
    if strict then
      der(y) = smooth(0, noEvent(if val < Falling then Falling elseif val > Rising then Rising else val));
    else
      der(y) = if val < Falling then Falling elseif val > Rising then Rising else val;
    end if;
  end SlewRateLimiter;

  block DeadZone "Zero in a zone, the distance from the zone outside"
    parameter Real uMax(start = 1) "upper end of the zone";
    parameter Real uMin = -uMax "lower end of the zone";
    extends Interfaces.SISO;
  equation
    assert(uMax >= uMin, "uMax has to be at least uMin");
    y = smooth(0, if u > uMax then u - uMax elseif u < uMin then u - uMin else 0);
  end DeadZone;

  block FixedDelay "The input some time before"
    extends Interfaces.SISO;
    parameter SI.Time delayTime(start = 1) "the time";
  equation
    y = delay(u, delayTime);
  end FixedDelay;

  block VariableDelay "The input a variable time before"
    extends Interfaces.SISO;
    parameter SI.Duration delayMax(min = 0, start = 1) "longest time";
    Interfaces.RealInput delayTime "the time";
  equation
    y = delay(u, delayTime, delayMax);
  end VariableDelay;
end Nonlinear;
