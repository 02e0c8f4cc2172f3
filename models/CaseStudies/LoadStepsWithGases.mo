within CaseStudies;
model LoadStepsWithGases "LoadSteps with gases and water that move"
  parameter FuelCellLib.Units.AreaResistance R_inf(min = 1e-4) = 0.03315 "low resistance of the load";
  parameter FuelCellLib.Units.AreaResistance R_sup(min = 1e-4) = 5.1 "high resistance of the load";
  parameter FuelCellLib.Units.CapacitanceDensity Cdl(min = 1e-3) = 10.12 "double layer, for each um of layer";
  parameter FuelCellLib.Units.Conductivity ks(min = 1e-6) = 0.01 "electronic conductivity of the solid";
  extends FuelCellLib.casestudies.Cell(
    act_layer1(ModHyp1 = 1, cdl = Cdl, ks = ks));
  FuelCellLib.Basics.Loads.Cycle_Load load(R_inf = R_inf, R_sup = R_sup) "R_sup from 0, R_inf from 5, R_sup from 12, R_inf from 20 s";
equation
  connect(act_layer1.exa2, col_cat1.exa1);
  connect(load.p, col_mem1.exa2);
  connect(load.n, col_cat1.exa2);
  annotation(
    experiment(StartTime = 0, StopTime = 25, Interval = 0.1, Tolerance = 1e-4),
    Documentation(info = "<html>
<p>The same cell as <a href=\"modelica://CaseStudies.LoadSteps\">LoadSteps</a>, of the layers of FuelCellLib.</p>
</html>"));
end LoadStepsWithGases;
