within CaseStudies;
model WaterEffect "Slow effect of water on the voltage of a fuel cell at a constant load"
  import Units = FuelCellLib.Units;
  parameter Units.Length da_act(min = 1e-9) = 6e-8 "thickness of an element of the active layer, which has 11";
  parameter Units.factor Xs(min = 1e-3) = 0.05 "pores of the diffusion layer: water that fills them, kg for each kg of solid";
  parameter Units.c_diff D12(min = 1e-11) = 5.01e-9 "binary diffusion coefficient, effective";
  parameter Units.Length da_mem(min = 1e-7) = 1.6e-5 "thickness of an element of the membrane, which has 11";
  parameter Units.AreaResistance Rmem(min = 1e-6) = 1.419e-3 "resistance of the membrane at the start";
  parameter Integer n(min = 1) = 10 "elements in each layer" annotation(Evaluate = true);
  parameter Units.AreaResistance Rload = 0.02 "resistance of the load";
  parameter Units.Potential Eref = 1.1 "reference of the open circuit voltage";
  parameter Units.Pressure pH2 = 1e5 "hydrogen";
  inner Water.Properties properties(n = n, D12 = D12) "what the layers share";
  final inner parameter Units.Potential Eoc = Eref - 0.9e-3*(properties.T - 298) + properties.RT/(2*FuelCellLib.Basics.F)*
    log(pH2/1e5*sqrt(properties.P/1e5)/(properties.RHc*properties.psat/1e5)) "open circuit voltage";
  Water.Anode anode;
  Water.Membrane membrane(h = 11/(n + 1)*da_mem, Rmem = Rmem);
  Water.ActiveLayer active(h = 11/(n + 1)*da_act);
  Water.DiffusionLayer diffusion(h = 11/(n + 1)*1e-5, Xs = Xs);
  Water.Channel channel;
  Modelica.Electrical.Analog.Basic.Resistor load(R = Rload);
  output Units.Potential V "cell voltage";
equation
  V = load.n.v;
  connect(anode.water, membrane.water1);
  connect(anode.ion, membrane.ion1);
  connect(membrane.water2, active.water1);
  connect(membrane.ion2, active.ion1);
  connect(active.gas2, diffusion.gas1);
  connect(diffusion.gas2, channel.gas);
  connect(anode.pin, load.p);
  connect(active.pin, load.n);
  annotation(experiment(StartTime = 0, StopTime = 9000, Interval = 60, Tolerance = 1e-4));
end WaterEffect;
