within FuelCellLib.Basics;
connector exac "What two parts of a layer have in common"
  Units.Pressure p(start = 1e5) "pressure of oxygen";
  Units.Pressure pwg(start = 1e5) "pressure of water vapour";
  Units.Potential vs "potential of the solid";
  Units.Potential ve "potential of the electrolyte";
  Units.Wload Xs(start = 0, nominal = 1e-3) "liquid water per solid";
  flow Units.molarF j(nominal = 1e-3) "oxygen";
  flow Units.molarF jwg(nominal = 1e-3) "water vapour";
  flow Units.molarF jwl(nominal = 1e-3) "liquid water";
  flow Units.CurrentDensity je "electrons";
  flow Units.CurrentDensity jp "protons";
end exac;
