within FuelCellLib.Basics;
connector terminal "Electric terminal of a cell of unit area; joins with a pin of Modelica.Electrical.Analog"
  Units.Potential v "potential";
  flow Real i "current into the component, A for each m2 of cell: without a unit, as pins count in A";
end terminal;
