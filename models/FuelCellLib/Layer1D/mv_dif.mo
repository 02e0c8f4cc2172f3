within FuelCellLib.Layer1D;
model mv_dif "Control volume of a diffusion layer and the element to the next"
  Basics.exac exa1 "towards the anode";
  Basics.exac exa2 "towards the cathode";
  Basics.vc_dif vc_dif1 "control volume";
  Basics.tp_dif tp_dif1 "transport element";
equation
  connect(exa1, vc_dif1.exa1);
  connect(vc_dif1.exa1, tp_dif1.exa1);
  connect(tp_dif1.exa2, exa2);
end mv_dif;
