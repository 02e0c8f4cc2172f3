within FuelCellLib.casestudies;
model FC2Layer "Cell of membrane and catalytic layer"
  extends Cell;
  Modelica.Electrical.Analog.Basic.Resistor RL1(R = 5e-4) "load, R in Ohm.m2";
equation
  connect(act_layer1.exa2, col_cat1.exa1);
  connect(RL1.p, col_mem1.exa2);
  connect(RL1.n, col_cat1.exa2);
  annotation(
    experiment(StartTime = 0, StopTime = 0.5, Interval = 0.005, Tolerance = 1e-4),
    Documentation(info = "<html>
<p>Voltage at three loads (V), for <code>n</code> per layer and <code>da = L/(n + 1)</code>, L = 11 um of catalytic layer, 110 um of membrane:</p>
<table border=\"1\">
<tr><th>n</th><th>1e-2 Ohm.m2</th><th>5e-4 Ohm.m2</th><th>1.4e-4 Ohm.m2</th></tr>
<tr><td>10</td><td>0.7726933</td><td>0.3748005</td><td>0.1994044</td></tr>
<tr><td>20</td><td>0.7726936</td><td>0.3748037</td><td>0.1994091</td></tr>
<tr><td>40</td><td>0.7726937</td><td>0.3748045</td><td>0.1994104</td></tr>
<tr><td>80</td><td>0.7726938</td><td>0.3748048</td><td>0.1994107</td></tr>
</table>
<p>The error falls with the square of the size of a control volume. <code>legacy = true</code> gives the
original's voltages: 1.0524, 0.9877, 0.8619, 0.7902, 0.6550, 0.5756, 0.5297, 0.4531, 0.3991, 0.3763, 0.3241 V
at 1.02, 0.1, 0.02, 0.01, 3e-3, 1.5e-3, 1e-3, 5e-4, 3e-4, 2.4e-4 and 1.4e-4 Ohm.m2.</p>
<p>A polarization curve: <code>scripts/polarization/pol_curve_FC2.mos</code> of the project.</p>
</html>"));
end FC2Layer;
