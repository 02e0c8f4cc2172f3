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
<p>Processor time of one simulation (0.5 s, tolerance 1e-4, 100 output intervals) and of a step, for each state, on finer
meshes of the same layers (<code>cargo bench --bench mesh</code>, on a machine that did other work as well, with about a tenth fewer iterations than now). From n = 200 to 2,000 the time of a simulation grows by a factor of 15, from n = 10 to 200 by 37:</p>
<table border=\"1\">
<tr><th>n</th><th>states</th><th>translation, s</th><th>steps</th><th>simulation, ms</th><th>step and state, us</th></tr>
<tr><td>10</td><td>55</td><td>0.03</td><td>52</td><td>1.55</td><td>0.54</td></tr>
<tr><td>20</td><td>105</td><td>0.09</td><td>52</td><td>3.62</td><td>0.66</td></tr>
<tr><td>50</td><td>255</td><td>0.23</td><td>53</td><td>10.3</td><td>0.76</td></tr>
<tr><td>100</td><td>505</td><td>0.42</td><td>51</td><td>22.9</td><td>0.89</td></tr>
<tr><td>200</td><td>1005</td><td>0.99</td><td>51</td><td>56.5</td><td>1.10</td></tr>
<tr><td>500</td><td>2505</td><td>2.09</td><td>51</td><td>165</td><td>1.29</td></tr>
<tr><td>1000</td><td>5005</td><td>5.46</td><td>51</td><td>562</td><td>2.20</td></tr>
<tr><td>2000</td><td>10005</td><td>10.74</td><td>51</td><td>876</td><td>1.72</td></tr>
</table>
<p><img src=\"modelica://FuelCellLib/Resources/Images/mesh.svg\" alt=\"Time of a simulation and of a step over the number of states\"></p>
<p>A polarization curve: <code>scripts/polarization/pol_curve_FC2.mos</code> of the project.</p>
</html>"));
end FC2Layer;
