within FuelCellLib;
package Units "Units of a fuel cell per unit area"
  type volpore = Real(final quantity = "VolumeFraction", final unit = "1", min = 0) "Fraction of the volume";
  type factor = Real(final quantity = "Factor", final unit = "1") "Switch or number";
  type Wload = Real(final quantity = "WaterLoading", final unit = "kg/kg") "Liquid water per solid";
  type Potential = Real(final quantity = "ElectricPotential", final unit = "V");
  type TafelSlope = Potential "Tafel slope, for the natural logarithm";
  type CurrentDensity = Real(final quantity = "CurrentDensity", final unit = "A/m2");
  type Aio = Real(final quantity = "VolumetricCurrentDensity", final unit = "A/m3") "Current of a volume";
  type CapacitanceDensity = Real(final quantity = "CapacitanceDensity", final unit = "F/m2");
  type Conductivity = Real(final quantity = "Conductivity", final unit = "S/m");
  type AreaResistance = Real(final quantity = "AreaResistance", final unit = "Ohm.m2");
  type molarF = Real(final quantity = "MolarFlux", final unit = "mol/(m2.s)");
  type molarRate = Real(final quantity = "MolarRate", final unit = "mol/(m3.s)") "Amount formed in a volume";
  type Pressure = Real(final quantity = "Pressure", final unit = "Pa", displayUnit = "Pa", nominal = 1e5);
  type Temp_K = Real(final quantity = "ThermodynamicTemperature", final unit = "K", min = 0);
  type Time = Real(final quantity = "Time", final unit = "s");
  type Length = Real(final quantity = "Length", final unit = "m", min = 0);
  type Density = Real(final quantity = "Density", final unit = "kg/m3", min = 0);
  type MolarMass = Real(final quantity = "MolarMass", final unit = "kg/mol", min = 0);
  type MolarConcentration = Real(final quantity = "Concentration", final unit = "mol/m3");
  type EnthalpyxMol = Real(final quantity = "MolarEnthalpy", final unit = "J/mol");
  type SpecificEnthalpy = Real(final quantity = "SpecificEnthalpy", final unit = "J/kg");
  type MolarGasConstant = Real(final quantity = "MolarGasConstant", final unit = "J/(mol.K)");
  type c_diff = Real(final quantity = "DiffusionCoefficient", final unit = "m2/s", min = 0);
  type beta = Real(final quantity = "MassTransferCoefficient", final unit = "m/s", min = 0);
  type alfav = Real(final quantity = "SpecificSurface", final unit = "m2/m3", min = 0);
  annotation(Documentation(info = "<html>
<p>SI units throughout; flows are per square metre of cell.</p>
</html>"));
end Units;
