within CaseStudies.Water;
model PoreElement "Gases and liquid water between two points of a porous layer"
  Gas gas1 "towards the anode";
  Gas gas2 "towards the channel";
  outer Properties properties;
  outer parameter Units.Length h;
  outer parameter Units.volpore eps;
  outer parameter Units.factor tau;
  outer parameter Units.c_diff D1co;
  outer parameter Units.c_diff D2co;
  parameter Units.factor g1 = 0.5 "length on the side of gas1, in h" annotation(Evaluate = true);
  parameter Units.factor g2 = 0.5 "length on the side of gas2, in h" annotation(Evaluate = true);
protected
  final parameter Real k(final unit = "mol.s2/(kg.m3)") = eps/(tau^2*properties.RT*(g1 + g2)*h);
  final parameter Real kO = k/(1/properties.Db + 1/D1co) "conductance of dry pores for oxygen";
  final parameter Real kW = k/(1/properties.Db + 1/D2co) "conductance of dry pores for vapour";
  Units.factor free "share of the diffusion that the liquid leaves";
equation
  free = (1 - (g1*gas1.s + g2*gas2.s)/(g1 + g2))^properties.m;
  gas1.jO = kO*free*(gas1.p - gas2.p);
  gas1.jW = kW*free*(gas1.w - gas2.w);
  gas1.jL = properties.cw*properties.Kl*(gas1.s - gas2.s)/((g1 + g2)*h);
  gas1.jO + gas2.jO = 0;
  gas1.jW + gas2.jW = 0;
  gas1.jL + gas2.jL = 0;
  annotation(Documentation(info = "<html>
<pre>
j  = -eps (1 - s)^m D/(tau^2 R T) dp/dx,   1/D = 1/Db + 1/D_Knudsen,   Db = D12 (T/Tref)^1.5
jL = -cw Kl ds/dx
</pre>
<p>(1 - s)^2 after Nam and Kaviany, Int. J. Heat Mass Transfer 46 (2003) 4595; others have an exponent
of 3.</p>
</html>"));
end PoreElement;
