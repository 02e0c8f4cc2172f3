within FuelCellLib.Basics;
model vc_mem "Control volume of a membrane"
  extends ControlVolume;
  outer parameter Units.Density rom;
equation
  exa1.p = 0;
  exa1.vs = 0;
  exa1.jp = 0;
  if frozen then
    exa1.pwg = pwg_start;
    exa1.Xs = Xs_start;
  else
    exa1.pwg/RT*Ego*(sink - der(exa1.Xs)/XsVolume) + Ega/RT*der(exa1.pwg) = exa1.jwg/da - condensed;
    rom/massh2o*der(exa1.Xs) = exa1.jwl/da + condensed;
  end if;
  annotation(Documentation(info = "<html>
<p>The balances of vapour and liquid of <a href=\"modelica://FuelCellLib.Basics.vc_act\">vc_act</a>
without a reaction. There is no oxygen and no electronic potential in a membrane: both are zero.</p>
</html>"));
end vc_mem;
