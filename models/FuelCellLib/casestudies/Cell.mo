within FuelCellLib.casestudies;
partial model Cell "Membrane, catalytic layer, collectors and what they share"
  parameter Boolean legacy = false "the equations of FuelCellLib 1.0, with its errors" annotation(Evaluate = true);
  inner Basics.Corrections corrections(legacy = legacy) "corrections of the equations";
  inner parameter Units.Temp_K T = 340 "temperature at the collectors";
  inner parameter Units.Potential Eref = 1.1 "reference of the open circuit voltage";
  inner parameter Units.Pressure pH2 = 1e5 "pressure of hydrogen";
  inner Units.Potential Eoc = col_cat1.Eoc "open circuit voltage";
  Layer1D.mem_layer mem_layer1 "membrane";
  Layer1D.act_layer act_layer1 "catalytic layer";
  Basics.col_mem col_mem1 "anode";
  Basics.col_cat col_cat1 "cathode";
  Units.Potential V "cell voltage";
  output Real Jecm(final unit = "A/cm2") "flux of electrons into the collector: the negative current density";
equation
  V = col_cat1.exa2.v - col_mem1.exa2.v;
  Jecm = col_cat1.exa1.je/1e4;
  connect(col_mem1.exa1, mem_layer1.exa1);
  connect(mem_layer1.exa2, act_layer1.exa1);
end Cell;
