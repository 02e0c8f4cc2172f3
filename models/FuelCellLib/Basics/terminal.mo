within FuelCellLib.Basics;
connector terminal "Electric terminal of a cell of unit area; joins with a pin of Modelica.Electrical.Analog"
  Units.Potential v "potential";
  flow Units.CurrentDensity i "current density into the component";
end terminal;
