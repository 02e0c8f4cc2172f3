within CaseStudies.Currents;
model ActiveLayer "Active layer of n + 1 control volumes at constant pressures"
  FuelCellLib.Basics.terminal ion "at the membrane";
  FuelCellLib.Basics.terminal pin "at the collector";
  parameter Integer n(min = 1) = 10 "elements: the layer has n + 1 control volumes" annotation(Evaluate = true);
  inner parameter Units.Length h = 1e-6 "thickness of a control volume";
  inner parameter Units.volpore Ee = 0.2 "electrolyte";
  inner parameter Units.Conductivity ks = 1e6 "electronic conductivity of the solid";
  inner parameter Units.Conductivity kpo = 10 "ionic conductivity of the electrolyte";
  inner parameter Units.CurrentDensity Aioref = 1.28 "exchange current, for each um of layer";
  inner parameter Units.TafelSlope B = 0.150 "Tafel slope, natural logarithm";
  inner parameter Units.CurrentDensity jlim = 2400 "limiting current, for each um of layer";
  inner parameter Units.CapacitanceDensity cdl = 1 "double layer, for each um of layer";
  ProtonFace protons "face of the membrane";
  Element first(g1 = 0) "half element at the membrane";
  Reaction c[n + 1] "control volumes";
  Element e[n] "elements between them";
  Element last(g2 = 0) "half element at the collector";
  ElectronFace electrons "face of the collector";
equation
  connect(ion, protons.ion);
  connect(protons.charge, first.charge1);
  connect(first.charge2, c[1].charge);
  for k in 1:n loop
    connect(c[k].charge, e[k].charge1);
    connect(e[k].charge2, c[k + 1].charge);
  end for;
  connect(c[n + 1].charge, last.charge1);
  connect(last.charge2, electrons.charge);
  connect(electrons.pin, pin);
end ActiveLayer;
