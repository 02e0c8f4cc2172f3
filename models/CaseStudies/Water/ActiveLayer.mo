within CaseStudies.Water;
model ActiveLayer "Active layer of n + 1 control volumes"
  Gas gas2 "at the diffusion layer";
  Ionomer water1 "at the membrane";
  FuelCellLib.Basics.terminal ion1 "at the membrane";
  FuelCellLib.Basics.terminal pin "at the diffusion layer";
  outer Properties properties;
  inner parameter Units.Length h = 6e-8 "thickness of a control volume";
  inner parameter Units.volpore eps = 0.1 "pores";
  inner parameter Units.volpore Ee = 0.2 "electrolyte";
  inner parameter Units.factor tau = 5 "tortuosity";
  inner parameter Units.c_diff D1co = 7.853e-7 "Knudsen diffusion of oxygen";
  inner parameter Units.c_diff D2co = 1.047e-6 "Knudsen diffusion of water vapour";
  inner parameter Units.Conductivity ks = 100 "electronic conductivity of the solid";
  inner parameter Units.Conductivity kpo = 10 "ionic conductivity of the electrolyte";
  inner parameter Units.CurrentDensity Aioref = 23.3 "exchange current, for each um of layer";
  inner parameter Units.TafelSlope B = 0.150 "Tafel slope, natural logarithm";
  inner parameter Units.Pressure poa = 1e5 "pressure of oxygen that Aioref belongs to";
  inner parameter Units.CapacitanceDensity cdl = 10.12 "double layer, for each um of layer";
  Currents.ProtonFace protons "face of the membrane";
  Currents.ElectronFace electrons "face of the diffusion layer";
  ActiveElement first(g1 = 0) "half element at the membrane";
  ActiveVolume c[properties.n + 1] "control volumes";
  ActiveElement e[properties.n] "elements between them";
  ActiveElement last(g2 = 0) "half element at the diffusion layer";
  Units.factor s "mean saturation";
equation
  connect(ion1, protons.ion);
  connect(protons.charge, first.charge1);
  connect(first.gas2, c[1].gas);
  connect(first.charge2, c[1].charge);
  for k in 1:properties.n loop
    connect(c[k].gas, e[k].gas1);
    connect(c[k].charge, e[k].charge1);
    connect(e[k].gas2, c[k + 1].gas);
    connect(e[k].charge2, c[k + 1].charge);
  end for;
  connect(c[properties.n + 1].gas, last.gas1);
  connect(c[properties.n + 1].charge, last.charge1);
  connect(last.gas2, gas2);
  connect(last.charge2, electrons.charge);
  connect(electrons.pin, pin);
  for k in 1:properties.n + 1 loop
    connect(water1, c[k].ionomer);
  end for;
  s = sum(c.gas.s)/(properties.n + 1);
  annotation(Documentation(info = "<html>
<p>The ionomer of the whole layer has the water content of the membrane's face and exchanges vapour in
every control volume. Gases do not enter the membrane, protons do not leave the layer.</p>
</html>"));
end ActiveLayer;
