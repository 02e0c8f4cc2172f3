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
  Modelica.Electrical.Analog.Basic.Resistor load(R = Rload/FuelCellLib.Basics.area);
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
  annotation(
    experiment(StartTime = 0, StopTime = 9000, Interval = 60, Tolerance = 1e-4),
    Documentation(info = "<html>
<p>A cell (membrane, active layer, diffusion layer) is connected to a resistance at the time 0. Its
voltage falls within ten seconds, rises by 33 mV in 40 minutes while the membrane takes up water, and
falls by 46 mV while liquid water fills the pores of the cathode: what Figure 6b of the paper shows.
The equations are those of <a href=\"modelica://CaseStudies.Water\">CaseStudies.Water</a>, class by
class.</p>
<p><img src=\"modelica://CaseStudies/Resources/Images/WaterEffect/voltage.svg\" alt=\"Cell voltage over time: a rise, then a fall\"></p>
<p>The rise: water from the anode spreads through the membrane, lambda goes from 3 to 13, and the resistance
falls to a fifth. It is the sorption by the ionomer that takes the time (L/ksorb = 1800 s), not the diffusion
(L^2/Dl = 100 s).</p>
<p><img src=\"modelica://CaseStudies/Resources/Images/WaterEffect/membrane_water.svg\" alt=\"Water per sulfonic group in each control volume of the membrane\">
<img src=\"modelica://CaseStudies/Resources/Images/WaterEffect/membrane_resistance.svg\" alt=\"Resistance of the membrane\"></p>
<p>The fall: with a wet membrane more water reaches the cathode than vapour can carry away; after 2000 s
the condensed water fills the pores (a saturation of 0.4 in the end), and less oxygen reaches the reaction.</p>
<p><img src=\"modelica://CaseStudies/Resources/Images/WaterEffect/saturation.svg\" alt=\"Saturation of the pores in each control volume\"></p>
<p>The figures are drawn by <code>scripts/water_effect/figures.mos</code>.</p>
<table border=\"1\">
<tr><th>time, s</th><th>V, n = 10</th><th>n = 20</th><th>n = 40</th><th>lambda, n = 10</th><th>saturation at the membrane</th><th>Rm, Ohm.m2</th></tr>
<tr><td>60</td><td>0.789282</td><td>0.789297</td><td>0.789301</td><td>3.39</td><td>.0002</td><td>1.218e-3</td></tr>
<tr><td>900</td><td>0.812457</td><td>0.812473</td><td>0.812478</td><td>7.69</td><td>.0010</td><td>4.761e-4</td></tr>
<tr><td>2100</td><td>0.817400</td><td>0.817412</td><td>0.817414</td><td>11.18</td><td>.0076</td><td>3.184e-4</td></tr>
<tr><td>4200</td><td>0.806248</td><td>0.806164</td><td>0.806092</td><td>13.43</td><td>.2070</td><td>2.624e-4</td></tr>
<tr><td>9000</td><td>0.771614</td><td>0.771472</td><td>0.771388</td><td>13.81</td><td>.4056</td><td>2.547e-4</td></tr>
</table>
<h4>What the five parameters mean</h4>
<ul>
<li>da_act, 6e-8 m: 11 elements make an active layer of 0.66 um, an ultra-thin film of catalyst.</li>
<li>Xs, 0.05: the pores of the diffusion layer, as the water that fills them per kilogram of solid:
<code>eps = 1/(1 + roh2ol/(ros Xs))</code> = 0.17. As a liquid loading of the layer it would exceed the
largest one; as a porosity it could not be searched above 1.</li>
<li>D12, 5.01e-9 m2/s: four orders below a gas; it is the diffusion of oxygen in liquid water, and can
only be an effective value of partly filled pores.</li>
<li>da_mem, 1.6e-5 m: 11 elements make 176 um, a Nafion 117.</li>
<li>Rmem, 1.419e-3 Ohm.m2: the membrane at the start (lambda = 3), with all that is in series with it.
Springer's conductivity gives 9.2e-5; so it sets the ratio to later times here, and Rmem the size.</li>
</ul>
<p>Fixed choices change the voltage, too, at most by: 186 mV for the diffusion Kl of liquid water of 3e-13,
37 mV for the exponent m = 3, 42 and 22 mV for RHa and RHc = 0.8, 26 mV for twice the sorption ksorb, 18 mV for
Dl = 1e-10, 11 mV for lambda0 = 5, 5 mV for ten times or a tenth of kc
(<code>scripts/water_effect/fixed_choices.mos</code>). ksorb of a dry film is limited by swelling, two orders slower than permeation: P. W. Majsztrik et al., J. Membr.
Sci. 301 (2007) 93. B = 0.15 V is the library's value.</p>
</html>"));
end WaterEffect;
