within FuelCellLib.casestudies;
model FC3Layer "Cell of membrane, catalytic layer and diffusion layer"
  extends Cell;
  Layer1D.dif_layer dif_layer1 "diffusion layer";
  Modelica.Electrical.Analog.Basic.Resistor RL1(R = 1e-3) "load, R in Ohm.m2";
equation
  connect(act_layer1.exa2, dif_layer1.exa1);
  connect(dif_layer1.exa2, col_cat1.exa1);
  connect(RL1.p, col_mem1.exa2);
  connect(RL1.n, col_cat1.exa2);
  annotation(
    experiment(StartTime = 0, StopTime = 0.5, Interval = 0.005, Tolerance = 1e-4),
    Documentation(info = "<html>
</html>"));
end FC3Layer;
