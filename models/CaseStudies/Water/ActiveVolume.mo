within CaseStudies.Water;
model ActiveVolume "Reaction in a part of an active layer"
  extends PoreVolume(oxygen = -i/(4*F*h), vapour = i/(2*F*h) + ionomer.J/h);
  Ionomer ionomer "the layer's ionomer";
  Charge charge(delta(nominal = 1)) "currents";
  outer parameter Units.CurrentDensity Aioref;
  outer parameter Units.TafelSlope B;
  outer parameter Units.Pressure poa;
  outer parameter Units.CapacitanceDensity cdl;
  outer Units.Potential Eoc;
  Units.CurrentDensity i "current of the reaction";
protected
  constant Units.Length dref = 1e-6 "thickness of layer that Aioref and cdl belong to";
initial equation
  charge.delta = Eoc;
equation
  i = Aioref*h/dref*(gas.p/poa*exp((Eoc - charge.delta)/B) - 1);
  charge.ion = i - cdl*h/dref*der(charge.delta);
  charge.total = 0;
  ionomer.J = properties.kk/(properties.n + 1)*(ionomer.lambda - sorption(gas.w/properties.psat));
  annotation(Documentation(info = "<html>
<p>Reduction of oxygen, of first order in its pressure, beside a double layer; and vapour that the
ionomer of the layer gives off:</p>
<pre>
i = Aioref (h/dref) [(p/poa) exp((Eoc - delta)/B) - 1],   delta = vs - ve
ion current into the volume = i - cdl (h/dref) d(delta)/dt
J = cf ksorb/N [lambda - lambda_eq(w/psat)]
</pre>
</html>"));
end ActiveVolume;
