within CaseStudies.Water;
model PoreVolume "Pores of a part of a layer: oxygen, vapour and liquid water"
  Gas gas "what flows in";
  outer Properties properties;
  outer parameter Units.Length h;
  outer parameter Units.volpore eps;
  Units.molarRate oxygen "oxygen that is formed";
  Units.molarRate vapour "vapour that is formed";
  Units.molarRate condensed "vapour that condenses";
protected
  Units.Pressure x "overpressure of the vapour";
  Units.Pressure r "absolute value of it, smoothly";
initial equation
  gas.p = properties.P;
  gas.w = properties.RHc*properties.psat;
  gas.s = 0;
equation
  x = gas.w - properties.psat;
  r = sqrt(x^2 + (0.01*properties.psat)^2);
  condensed = properties.kc/properties.RT*(0.5*(r + x) - gas.s*r);
  eps/properties.RT*((1 - gas.s)*der(gas.p) - gas.p*der(gas.s)) = gas.jO/h + oxygen;
  eps/properties.RT*((1 - gas.s)*der(gas.w) - gas.w*der(gas.s)) = gas.jW/h + vapour - condensed;
  properties.cw*eps*der(gas.s) = gas.jL/h + condensed;
  annotation(Documentation(info = "<html>
<pre>
eps/(R T) d[(1 - s) p]/dt = jO/h + oxygen
eps/(R T) d[(1 - s) w]/dt = jW/h + vapour - S
cw eps ds/dt              = jL/h + S
S = kc/(R T) [(r + x)/2 - s r],   x = w - psat,   r = sqrt(x^2 + (0.01 psat)^2)
</pre>
<p>Condensation goes with the share of the pores that is free, evaporation with that which is full;
the smooth root keeps the saturation between 0 and 1 without events. The width of 1 % is a constant of
the model.</p>
</html>"));
end PoreVolume;
