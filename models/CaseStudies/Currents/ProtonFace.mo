within CaseStudies.Currents;
model ProtonFace "Face that lets protons pass and no electrons"
  FuelCellLib.Basics.terminal ion "protons";
  Charge charge "layer";
equation
  ion.v = charge.ve;
  ion.i + charge.ion = 0;
  charge.total = charge.ion;
end ProtonFace;
