within CaseStudies.Water;
model Membrane "Membrane of n + 1 control volumes"
  Ionomer water1 "at the anode";
  Ionomer water2 "at the active layer";
  FuelCellLib.Basics.terminal ion1 "at the anode";
  FuelCellLib.Basics.terminal ion2 "at the active layer";
  outer Properties properties;
  inner parameter Units.Length h = 1.6e-5 "thickness of a control volume";
  inner parameter Units.AreaResistance Rmem = 1.419e-3 "resistance of the membrane at lambda0";
  MembraneElement first(g1 = 0) "half element at the anode";
  MembraneVolume c[properties.n + 1] "control volumes";
  MembraneElement e[properties.n] "elements between them";
  MembraneElement last(g2 = 0) "half element at the active layer";
  Units.AreaResistance Rm "resistance";
  Units.factor lambda "mean water per sulfonic group";
equation
  connect(water1, first.water1);
  connect(ion1, first.ion1);
  connect(first.water2, c[1].water);
  connect(first.ion2, e[1].ion1);
  for k in 1:properties.n loop
    connect(c[k].water, e[k].water1);
    connect(e[k].water2, c[k + 1].water);
  end for;
  for k in 1:properties.n - 1 loop
    connect(e[k].ion2, e[k + 1].ion1);
  end for;
  connect(c[properties.n + 1].water, last.water1);
  connect(e[properties.n].ion2, last.ion1);
  connect(last.water2, water2);
  connect(last.ion2, ion2);
  Rm = first.Rm + sum(e.Rm) + last.Rm;
  lambda = sum(c.water.lambda)/(properties.n + 1);
end Membrane;
