within FuelCellLib.Basics;
model vc_dif "Control volume of a diffusion layer"
  extends ControlVolume(exa1(p(start = p_start, fixed = not frozen)));
  outer parameter Units.Pressure p_start;
  outer parameter Units.Density ros;
equation
  exa1.je = 0;
  exa1.jp = 0;
  if frozen then
    exa1.p = p_start;
    exa1.pwg = pwg_start;
    exa1.Xs = Xs_start;
  else
    exa1.p/RT*Ego*(sink - der(exa1.Xs)/XsVolume) + Ega/RT*der(exa1.p) = exa1.j/da;
    exa1.pwg/RT*Ego*(sink - der(exa1.Xs)/XsVolume) + Ega/RT*der(exa1.pwg) = exa1.jwg/da - condensed;
    ros/massh2o*der(exa1.Xs) = exa1.jwl/da + condensed;
  end if;
  annotation(Documentation(info = "<html>
<p>The balances of <a href=\"modelica://FuelCellLib.Basics.vc_act\">vc_act</a> without a reaction, the
liquid per mass of this layer's solid (ros).</p>
</html>"));
end vc_dif;
