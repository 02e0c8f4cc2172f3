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
<p>Processor time of one simulation (0.5 s, tolerance 1e-4, 100 output intervals) and of a step, for each state, on finer
meshes of the same layers (<code>cargo bench --bench mesh</code>, on a machine that did other work as well, with about a tenth fewer iterations than now). From n = 200 to 2,000 the time of a simulation grows by a factor of 11, from n = 10 to 200 by 47:</p>
<table border=\"1\">
<tr><th>n</th><th>states</th><th>translation, s</th><th>steps</th><th>simulation, ms</th><th>step and state, us</th></tr>
<tr><td>10</td><td>88</td><td>0.14</td><td>44</td><td>2.38</td><td>0.61</td></tr>
<tr><td>20</td><td>168</td><td>0.10</td><td>47</td><td>5.81</td><td>0.74</td></tr>
<tr><td>50</td><td>408</td><td>0.28</td><td>47</td><td>14.8</td><td>0.77</td></tr>
<tr><td>100</td><td>808</td><td>0.76</td><td>47</td><td>40.3</td><td>1.06</td></tr>
<tr><td>200</td><td>1608</td><td>1.58</td><td>47</td><td>111</td><td>1.47</td></tr>
<tr><td>500</td><td>4008</td><td>3.16</td><td>47</td><td>212</td><td>1.13</td></tr>
<tr><td>1000</td><td>8008</td><td>7.15</td><td>47</td><td>564</td><td>1.50</td></tr>
<tr><td>2000</td><td>16008</td><td>17.06</td><td>47</td><td>1264</td><td>1.68</td></tr>
</table>
<p><img src=\"modelica://FuelCellLib/Resources/Images/mesh.svg\" alt=\"Time of a simulation and of a step over the number of states\"></p>
<p>A polarization curve: <code>scripts/polarization/pol_curve_FC3.mos</code> of the project.</p>
</html>"));
end FC3Layer;
