within CaseStudies.Water;
model Anode "Humid hydrogen: water and protons at potential zero"
  Ionomer water "membrane";
  FuelCellLib.Basics.terminal ion "membrane";
  FuelCellLib.Basics.terminal pin "load";
  outer Properties properties;
equation
  -water.J = properties.kk*(sorption(properties.RHa) - water.lambda);
  ion.v = 0;
  pin.v = 0;
end Anode;
