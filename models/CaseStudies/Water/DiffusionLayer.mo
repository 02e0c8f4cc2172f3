within CaseStudies.Water;
model DiffusionLayer "Diffusion layer of n + 1 control volumes, an ideal conductor"
  Gas gas1 "at the active layer";
  Gas gas2 "at the channel";
  outer Properties properties;
  parameter Units.factor Xs = 0.05 "water that fills the pores, kg for each kg of solid";
  parameter Units.Density ros = 4000 "density of the solid";
  inner parameter Units.Length h = 1e-5 "thickness of a control volume";
  inner parameter Units.factor tau = 1 "tortuosity";
  inner parameter Units.c_diff D1co = 7.853e-6 "Knudsen diffusion of oxygen";
  inner parameter Units.c_diff D2co = 1.047e-5 "Knudsen diffusion of water vapour";
  final inner parameter Units.volpore eps = 1/(1 + properties.roh2ol/(ros*Xs)) "pores";
  PoreElement first(g1 = 0) "half element at the active layer";
  PoreVolume c[properties.n + 1](each oxygen = 0, each vapour = 0) "control volumes";
  PoreElement e[properties.n] "elements between them";
  PoreElement last(g2 = 0) "half element at the channel";
  Units.factor s "mean saturation";
equation
  connect(gas1, first.gas1);
  connect(first.gas2, c[1].gas);
  for k in 1:properties.n loop
    connect(c[k].gas, e[k].gas1);
    connect(e[k].gas2, c[k + 1].gas);
  end for;
  connect(c[properties.n + 1].gas, last.gas1);
  connect(last.gas2, gas2);
  s = sum(c.gas.s)/(properties.n + 1);
end DiffusionLayer;
