within FuelCellLib.Layer1D;
model mv_act "Control volume of a catalytic layer and the element to the next"
  Basics.exac exa1 "towards the anode";
  Basics.exac exa2 "towards the cathode";
  Basics.vc_act vc_act1 "control volume";
  Basics.tp_act tp_act1 "transport element";
equation
  connect(exa1, vc_act1.exa1);
  connect(vc_act1.exa1, tp_act1.exa1);
  connect(tp_act1.exa2, exa2);
end mv_act;
