within FuelCellLib.Basics;
model tp_act "Transport element of a catalytic layer"
  extends PorousTransport;
  outer parameter Units.volpore Ee;
  outer parameter Units.Conductivity kpo;
  outer parameter Units.Density rom;
  outer parameter Units.factor ModHyp3;
  outer parameter Units.factor ModHyp4;
  outer parameter Units.factor LSO3;
  parameter Units.factor sign = 1 "of the temperature in the original's conductivity" annotation(Evaluate = true);
  final parameter Units.factor ndrag = if ModHyp3 == 1 then 2.5*LSO3*Ee/22 else 0 "water that a proton drags along";
  final parameter Units.Conductivity kp =
    if ModHyp4 == 1 then membraneConductivity(LSO3, T, corrections.conductivity, sign) else kpo "ionic conductivity";
equation
  exa1.jwl = -rom/massh2o*Dwl*(exa2.Xs - exa1.Xs)/dx + ndrag*exa1.jp/F;
  exa1.jp = -kp*Ee*(exa2.ve - exa1.ve)/dx;
  annotation(Documentation(info = "<html>
<p>Beside what moves in every porous layer, protons, which may drag water along (Springer et al. 1991:
2.5 molecules at 22 per sulfonic group, in proportion below):</p>
<pre>
jwl = -(rom/M) Dwl dXs/dx + ndrag jp/F,   jp = -kp Ee dve/dx
</pre>
</html>"));
end tp_act;
