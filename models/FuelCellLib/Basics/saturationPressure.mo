within FuelCellLib.Basics;
function saturationPressure "Pressure of saturated water vapour"
  input Units.Temp_K T "temperature";
  input Units.Pressure posat "pressure at Tosat";
  input Units.Temp_K Tosat "temperature of posat";
  input Real linear(unit = "J/(kg.K)") "second coefficient of the heat of evaporation";
  input Units.MolarGasConstant R "molar gas constant";
  output Units.Pressure psat "saturation pressure";
protected
  Units.SpecificEnthalpy Lv "heat of evaporation";
algorithm
  Lv := 1.73287e6 + linear*T - 44.7755*T^2 + 7.6629e-2*T^3 - 5.5058e-5*T^4;
  psat := posat*exp((1/Tosat - 1/T)*Lv*massh2o/R);
  annotation(Inline = true, Documentation(info = "<html>
<p>Clausius-Clapeyron from one known point, with the heat of evaporation at T:</p>
<pre>
psat = posat exp((1/Tosat - 1/T) Lv(T) M/R),
Lv   = 1.73287e6 + linear T - 44.7755 T^2 + 7.6629e-2 T^3 - 5.5058e-5 T^4  [J/kg]
</pre>
<p>With <code>linear = 1.03001e4</code> Lv is 2.335e6 J/kg at 340 K and the pressure 25.5 kPa (steam
tables: 27 kPa). The original has 1.03001e-4, a slip: Lv is negative at 340 K.</p>
</html>"));
end saturationPressure;
