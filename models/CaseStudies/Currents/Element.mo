within CaseStudies.Currents;
model Element "Protons and electrons between two points of a layer"
  Charge charge1 "towards the anode";
  Charge charge2 "towards the channel";
  outer parameter Units.Length h;
  outer parameter Units.Conductivity ks;
  outer parameter Units.Conductivity kpo;
  outer parameter Units.volpore Ee;
  parameter Units.factor g1 = 0.5 "length on the side of charge1, in h" annotation(Evaluate = true);
  parameter Units.factor g2 = 0.5 "length on the side of charge2, in h" annotation(Evaluate = true);
protected
  final parameter Units.AreaResistance rp = (g1 + g2)*h/(kpo*Ee) "resistance for protons";
  final parameter Units.AreaResistance rs = (g1 + g2)*h/ks "resistance for electrons";
equation
  charge1.ve - charge2.ve = rp*charge1.ion;
  charge1.ion = (charge2.delta - charge1.delta + rs*charge1.total)/(rs + rp);
  charge1.ion + charge2.ion = 0;
  charge1.total + charge2.total = 0;
  annotation(Documentation(info = "<html>
<p>Ohm's law for protons (rp) and electrons (rs), the second as the difference of both:</p>
<pre>
ve1 - ve2 = rp ion,   vs1 - vs2 = rs (total - ion),   delta = vs - ve
</pre>
</html>"));
end Element;
