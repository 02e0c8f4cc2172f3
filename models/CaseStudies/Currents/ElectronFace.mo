within CaseStudies.Currents;
model ElectronFace "Face that lets electrons pass and no protons"
  FuelCellLib.Basics.terminal pin "electrons";
  Charge charge "layer";
equation
  pin.v = charge.ve + charge.delta;
  pin.i + charge.total = 0;
  charge.ion = 0;
end ElectronFace;
