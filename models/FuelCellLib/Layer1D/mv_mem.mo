within FuelCellLib.Layer1D;
model mv_mem "Control volume of a membrane and the element to the next"
  Basics.exac exa1 "towards the anode";
  Basics.exac exa2 "towards the cathode";
  Basics.vc_mem vc_mem1 "control volume";
  Basics.tp_mem tp_mem1 "transport element";
equation
  connect(exa1, vc_mem1.exa1);
  connect(vc_mem1.exa1, tp_mem1.exa1);
  connect(tp_mem1.exa2, exa2);
end mv_mem;
