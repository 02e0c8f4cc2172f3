within FuelCellLib.Basics;
package Loads "Resistances that change with time"
  function uniform = GAPILib.Basics.Ram_Gen_ARENA "Numbers between 0 and 1";

  partial model Load "A resistance R between two pins"
    extends Modelica.Electrical.Analog.Interfaces.OnePort;
    Units.AreaResistance R "resistance";
  equation
    v = R/area*i;
  end Load;

  model Step_Load "One step of the resistance"
    extends Load(R(start = LowVal, fixed = true));
    parameter Units.AreaResistance HighVal = 1 "resistance after the step";
    parameter Units.AreaResistance LowVal = 0.01 "resistance before the step";
    parameter Units.Time StepT = 0.1 "time of the step";
  equation
    when time > StepT then
      R = HighVal;
    end when;
  end Step_Load;

  model PRB_Load "Pseudo-random binary resistance"
    extends Load;
    parameter Units.AreaResistance HighVal = 1 "high resistance";
    parameter Units.AreaResistance LowVal = 0.01 "low resistance";
    parameter Units.Time Period = 10 "longest time between two changes";
    parameter Integer seed[6] = fill(12345, 6) "start of the generator of random numbers";
    discrete Units.Time next(start = 0, fixed = true) "time of the next change";
    Boolean high(start = false, fixed = true) "the resistance is high";
  protected
    discrete Real draw[1,1](each start = 0, each fixed = true) "random number";
    discrete Real state[1,6](start = {seed}, each fixed = true) "state of the generator";
  equation
    when {initial(), time >= pre(next)} then
      (draw, state) = uniform(pre(state), 1);
      next = time + Period*draw[1, 1];
      high = not pre(high);
    end when;
    R = if high then HighVal else LowVal;
    annotation(Documentation(info = "<html>
<p>The resistance changes after times that are uniform between 0 and Period, drawn with
<a href=\"modelica://GAPILib.Basics.Ram_Gen_ARENA\">Ram_Gen_ARENA</a>: the same seed gives the same
signal. The original divides by Period where its help says that Period is the longest time; here it
is. The first change is at time 0, to the high value.</p>
</html>"));
  end PRB_Load;

  model Cycle_Load "Resistance that goes to and fro between two values at given times"
    extends Load;
    parameter Units.AreaResistance R_sup = 5.1 "high resistance, at the start";
    parameter Units.AreaResistance R_inf = 0.03315 "low resistance";
    parameter Units.Time change[:] = {5, 12, 20} "times of change, increasing";
    Boolean low(start = false, fixed = true) "the resistance is low";
  equation
    when {time >= change[k] for k in 1:size(change, 1)} then
      low = not pre(low);
    end when;
    R = if low then R_inf else R_sup;
  end Cycle_Load;
  annotation(Documentation(info = "<html>
<p>Resistances are in Ohm.m2: loads of a cell of unit area.</p>
</html>"));
end Loads;
