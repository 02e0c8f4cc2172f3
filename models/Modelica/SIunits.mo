within Modelica;
package SIunits "Types of quantities in SI units, under the name they had until version 3"
  extends Modelica.Units.SI;
  package Conversions "Functions between SI and other units"
    extends Modelica.Units.Conversions;
    package NonSIunits "Types of quantities in other units"
      extends Modelica.Units.NonSI;
      type Temp_degC = Temperature_degC "Temperature on the scale of Celsius";
    end NonSIunits;
  end Conversions;

  type Temp_K = ThermodynamicTemperature "Absolute temperature";
  type Temp_C = Modelica.Units.NonSI.Temperature_degC "Temperature on the scale of Celsius";
  type CelsiusTemperature = Modelica.Units.NonSI.Temperature_degC
    "Temperature on the scale of Celsius (name of version 1)";

  // Names as they were misspelt until version 3.
  type Wavelenght = Wavelength;
  type FluxiodQuantum = Real(final quantity = "FluxoidQuantum", final unit = "Wb");
  type RadiantExtiance = RadiantExitance;
  annotation(Documentation(info = "<html>
<p>Everything of <a href=\"modelica://Modelica.Units.SI\">Units.SI</a>, with the names that only the
earlier versions had.</p>
</html>"));
end SIunits;
