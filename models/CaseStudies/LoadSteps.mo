within CaseStudies;
model LoadSteps "Voltage of a fuel cell under steps of its load"
  import Units = FuelCellLib.Units;
  parameter Units.AreaResistance R_inf(min = 1e-4) = 0.03315 "low resistance of the load";
  parameter Units.AreaResistance R_sup(min = 1e-4) = 5.1 "high resistance of the load";
  parameter Units.CapacitanceDensity Cdl(min = 1e-3) = 10.12 "double layer, for each um of active layer";
  parameter Units.Conductivity ks(min = 1e-6) = 0.01 "electronic conductivity of the solid";
  parameter Integer n(min = 1) = 10 "elements of the active layer" annotation(Evaluate = true);
  parameter Units.Temp_K T = 340 "temperature";
  parameter Units.Potential Eref = 1.1 "reference of the open circuit voltage";
  parameter Units.Pressure pH2 = 1e5 "hydrogen";
  parameter Units.Pressure P = 1e5 "oxygen";
  parameter Units.Pressure PWG = 1e5 "water vapour";
  parameter Units.Length Lmem = 110e-6 "thickness of the membrane";
  parameter Units.Conductivity kp = 1 "conductivity of the membrane";
  final inner parameter Units.Potential Eoc = Eref - 0.9e-3*(T - 298) +
    8.31446*T/(2*FuelCellLib.Basics.F)*log(pH2/1e5*sqrt(P/1e5)/(PWG/1e5)) "open circuit voltage";
  Currents.ActiveLayer active(n = n, h = 11e-6/(n + 1), ks = ks, cdl = Cdl) "active layer, 11 um";
  Modelica.Electrical.Analog.Basic.Resistor membrane(R = Lmem/kp) "membrane, Ohm.m2";
  Modelica.Electrical.Analog.Basic.Ground anode "anode, without a loss";
  FuelCellLib.Basics.Loads.Cycle_Load load(R_inf = R_inf, R_sup = R_sup) "R_sup from 0, R_inf from 5, R_sup from 12, R_inf from 20 s";
  output Units.Potential V "cell voltage";
equation
  V = load.p.v;
  connect(anode.p, membrane.p);
  connect(membrane.n, active.ion);
  connect(active.pin, load.p);
  connect(load.n, anode.p);
  annotation(experiment(StartTime = 0, StopTime = 25, Interval = 0.1, Tolerance = 1e-4));
end LoadSteps;
