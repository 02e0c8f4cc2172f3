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
  Modelica.Electrical.Analog.Basic.Resistor membrane(R = Lmem/kp/FuelCellLib.Basics.area) "membrane";
  Modelica.Electrical.Analog.Basic.Ground anode "anode, without a loss";
  FuelCellLib.Basics.Loads.Cycle_Load load(R_inf = R_inf, R_sup = R_sup) "R_sup from 0, R_inf from 5, R_sup from 12, R_inf from 20 s";
  output Units.Potential V "cell voltage";
equation
  V = load.p.v;
  connect(anode.p, membrane.p);
  connect(membrane.n, active.ion);
  connect(active.pin, load.p);
  connect(load.n, anode.p);
  annotation(
    experiment(StartTime = 0, StopTime = 25, Interval = 0.1, Tolerance = 1e-4),
    Documentation(info = "<html>
<p>The load changes between R_sup and R_inf; the double layer of the active layer makes the voltage
follow in about a second. Start: open circuit. The current is 27 A/m2 at most, so the pressures stay as
they are: with gases and water that move, in
<a href=\"modelica://CaseStudies.LoadStepsWithGases\">LoadStepsWithGases</a> of the layers of FuelCellLib,
the voltage differs by less than 3e-7 V. Without them the cell is an explicit system of n + 1 states.</p>
<table border=\"1\">
<tr><th>time, s</th><th>V, n = 10</th><th>n = 20</th><th>n = 40</th><th>n = 80</th></tr>
<tr><td>4.5</td><td>1.059950</td><td>1.059950</td><td>1.059950</td><td>1.059950</td></tr>
<tr><td>5.2</td><td>0.995814</td><td>0.995846</td><td>0.995855</td><td>0.995857</td></tr>
<tr><td>6</td><td>0.905634</td><td>0.905662</td><td>0.905670</td><td>0.905672</td></tr>
<tr><td>11.5</td><td>0.889470</td><td>0.889498</td><td>0.889506</td><td>0.889508</td></tr>
<tr><td>13</td><td>1.011386</td><td>1.011386</td><td>1.011386</td><td>1.011386</td></tr>
</table>
<p>Cdl is 10.12 F/m2 for each um of the layer of 11 um, 111 F/m2 in all: as a value of the whole layer it
could not hold the voltage for a second. At the very time of a step the voltage depends on the mesh:
measured values at 5, 12 and 20 s mean nothing.</p>
</html>"));
end LoadSteps;
