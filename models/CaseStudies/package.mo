package CaseStudies "Models whose parameters the scripts identify"
  package Units "Units of electrochemistry"
    type Voltage = Real(final quantity = "ElectricPotential", final unit = "V");
    type CurrentDensity = Real(final quantity = "CurrentDensity", final unit = "A/cm2");
    type AreaResistance = Real(final quantity = "AreaResistance", final unit = "Ohm.cm2");
  end Units;
  annotation(
    version = "1.0.0",
    Documentation(info = "<html>
<p>The case studies of section 4 of: M. A. Rubio, A. Urquia, L. Gonzalez, D. Guinea, S. Dormido:
GAPILib - A Modelica Library for Model Parameter Identification Using Genetic Algorithms.
Proceedings of the 5th International Modelica Conference, 2006.</p>
</html>"));
end CaseStudies;
