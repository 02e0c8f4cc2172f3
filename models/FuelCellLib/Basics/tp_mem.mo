within FuelCellLib.Basics;
model tp_mem "Transport element of a membrane"
  extends Transport;
  outer parameter Units.volpore Ee;
  outer parameter Units.factor tau;
  outer parameter Units.Conductivity kpo;
  outer parameter Units.Density rom;
  outer parameter Units.c_diff D2;
  outer parameter Units.volpore Ego;
  outer parameter Units.Wload XsTransport;
  outer parameter Units.factor ModHyp3;
  outer parameter Units.factor ModHyp4;
  outer parameter Units.factor LSO3;
  parameter Units.factor sign = 1 "of the temperature in the original's conductivity" annotation(Evaluate = true);
  final parameter Units.factor ndrag = if ModHyp3 == 1 then 2.5*LSO3*Ee/22 else 0 "water that a proton drags along";
  final parameter Units.Conductivity kp =
    if ModHyp4 == 1 then membraneConductivity(LSO3, T, corrections.conductivity, sign) else kpo "ionic conductivity";
equation
  exa1.j = 0;
  exa1.je = 0;
  Ego/tau^2*(1 - Xs/XsTransport)*(exa2.pwg - exa1.pwg)/dx = -corrections.R*T*exa1.jwg/D2;
  exa1.jwl = -rom/massh2o*Dwl*(exa2.Xs - exa1.Xs)/dx + ndrag*exa1.jp/F;
  exa1.jp = -kp*(exa2.ve - exa1.ve)/dx;
  annotation(Documentation(info = "<html>
<p>Neither oxygen nor electrons pass. Vapour by Fick's law, liquid water and protons as in a
catalytic layer:</p>
<pre>
theta dw/dx = -R T jwg/D2,   jwl = -(rom/M) Dwl dXs/dx + ndrag jp/F,   jp = -kp dve/dx
</pre>
</html>"));
end tp_mem;
