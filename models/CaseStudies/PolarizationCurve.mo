within CaseStudies;
model PolarizationCurve "Polarization curve of a fuel cell, by a slow ramp of the current"
  parameter Units.Voltage A(min = 1e-4, max = 1) = 0.0390 "Tafel parameter RT/(alpha F)";
  parameter Units.CurrentDensity In(min = 0, max = 1) = 1.4e-3 "inner current density";
  parameter Units.CurrentDensity Io(min = 1e-15, max = 1) = 1.5856e-6 "exchange current density";
  parameter Units.Voltage B(min = 0, max = 1) = 0.0918 "mass-transport coefficient";
  parameter Units.AreaResistance R(min = 0, max = 10) = 7.2860e-4 "inner area specific resistance";
  parameter Units.CurrentDensity Ilim(min = 1e-3, max = 10) = 0.2265 "limiting transport current density";
  parameter Units.Voltage Eoc = 1.2 "open circuit voltage, reversible" annotation(Evaluate = true);
  parameter Units.CurrentDensity i_max = 0.22 "current density at the end of the ramp" annotation(Evaluate = true);
  Units.CurrentDensity i "current density";
  output Units.Voltage V "cell voltage";
equation
  assert(i + In > 0, "i + In > 0 does not hold: the activation loss has no logarithm");
  assert(i + In < Ilim, "i + In < Ilim does not hold: the current density reaches its limit");
  i = i_max*time;
  V = Eoc - R*(i + In) - A*log((i + In)/Io) + B*log(1 - (i + In)/Ilim);
  annotation(
    experiment(StartTime = 0, StopTime = 1, Interval = 0.002, Tolerance = 1e-6),
    Documentation(info = "<html>
<p>The steady-state voltage of a fuel cell is the open circuit voltage less four losses:</p>
<pre>
V = Eoc - R (i + In) - A ln((i + In)/Io) + B ln(1 - (i + In)/Ilim)
</pre>
<p>ohmic loss, activation loss (Tafel), and loss by mass transfer near the limiting current density;
the inner current density In stands for the crossover of fuel. The curve is run through by the ramp
<code>i = i_max time</code> from 0 to 1 s: there is no dynamics, so every point is a steady state.</p>
<p>The parameters to identify are those of Table 3 of the paper, their values those of Table 4.
<code>Eoc</code> and <code>i_max</code> are not identified: they are fixed when the model is
translated, and set by a modification such as
<code>CaseStudies.PolarizationCurve(i_max = 1.46)</code>.</p>
<h4>What must be known about the parameters</h4>
<ul>
<li>Table 4 prints R = 7.2860e-4 with the unit Ohm cm2. That resistance drops 0.16 mV at most, far
less than any measurement resolves. Larminie and Dicks print R in kOhm cm2; read so, R is
0.72860 Ohm cm2, a usual value for a membrane. The default here is the number as printed.</li>
<li>Eoc and Io cannot both be identified: Eoc + A ln(Io) is one constant. A and Io together are
strongly correlated for the same reason.</li>
<li>Where i + In reaches Ilim the equation has no solution; the simulation of such an individual
fails, which is normal in a search.</li>
</ul>
<h4>References</h4>
<p>J. Larminie, A. Dicks: Fuel Cell Systems Explained. Wiley, 2000, chapter 3.<br>
Rubio et al. 2006, section 4.1.</p>
</html>"));
end PolarizationCurve;
