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
<p>Voltage at three loads (V), for <code>n</code> per layer and <code>da = L/(n + 1)</code>, L = 11 um of catalytic layer, 110 um of membrane, 210 um of diffusion layer:</p>
<table border=\"1\">
<tr><th>n</th><th>1e-2 Ohm.m2</th><th>1e-3 Ohm.m2</th><th>1.4e-4 Ohm.m2</th></tr>
<tr><td>10</td><td>0.7726916</td><td>0.4743842</td><td>0.1993318</td></tr>
<tr><td>20</td><td>0.7726920</td><td>0.4743863</td><td>0.1993365</td></tr>
<tr><td>40</td><td>0.7726921</td><td>0.4743869</td><td>0.1993378</td></tr>
<tr><td>80</td><td>0.7726921</td><td>0.4743870</td><td>0.1993381</td></tr>
</table>
<p>The error falls with the square of the size of a control volume. The default mesh has n = 20 in the diffusion layer.</p>
<p>A polarization curve: <code>scripts/polarization/pol_curve_FC3.mos</code> of the project.</p>
</html>"));
end FC3Layer;
