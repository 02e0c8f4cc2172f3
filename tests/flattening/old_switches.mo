// Real parameters that choose equations by `==`, and `not` before a relation, which binds weaker
// than it: `not Hyp == 1` is `not (Hyp == 1)` (MLS §3.2).
package old_switches
  model Volume
    parameter Real Hyp = 0;
    parameter Real factor = 1;
    parameter Real cdl = 12;
    Real vs(start = 0), je, D;
  equation
    if not Hyp == 1 then
      0 = vs - je;
    else
      cdl*der(vs) = je - vs;
    end if;
    if factor == 1 then
      D = 1;
    elseif factor == 2 then
      D = 2;
    else
      D = factor;
    end if;
    je = time;
  end Volume;
  model Main
    Volume without;
    Volume with(Hyp = 1, factor = 2);
    Volume other(Hyp = 1.0, factor = 2.5);
  end Main;
end old_switches;
