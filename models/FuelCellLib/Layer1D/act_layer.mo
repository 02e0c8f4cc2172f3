within FuelCellLib.Layer1D;
model act_layer "Catalytic layer"
  Basics.exac exa1 "towards the anode";
  Basics.exac exa2 "towards the cathode";
  outer Basics.Corrections corrections;
  parameter Integer n(min = 1) = 10 "elements: the layer has n + 1 control volumes" annotation(Evaluate = true);
  inner parameter Units.Temp_K T = 340 "temperature";
  inner parameter Units.alfav av = 1e-9 "surface of condensation per volume";
  inner parameter Units.beta b = 1e-3 "mass transfer coefficient of condensation";
  inner parameter Units.Length da = 1e-6 "thickness of an element: the layer has (n + 1) da";
  inner parameter Units.volpore Es = 0.7 "solid fraction";
  inner parameter Units.volpore Ee = 0.2 "electrolyte fraction";
  inner parameter Units.factor tau = 5 "tortuosity";
  inner parameter Units.c_diff Dwl = 3.5e-9 "diffusion of liquid water";
  inner parameter Units.Conductivity ks = 1e6 "electronic conductivity of the solid";
  inner parameter Units.Conductivity kpo = 10 "ionic conductivity of the electrolyte";
  inner parameter Units.Pressure posat = 3169 "saturation pressure at Tosat";
  inner parameter Units.Temp_K Tosat = 298.16 "temperature of posat";
  inner parameter Units.Density roh2ol = 972 "density of liquid water";
  inner parameter Units.Density rom = 2000 "density of the electrolyte";
  inner parameter Units.Density ros = 4000 "density of the solid";
  inner parameter Units.MolarMass Mm = 1.1 "mass of the electrolyte per sulfonic group";
  inner parameter Units.CapacitanceDensity cdl = 1 "double layer, for each um of layer";
  inner parameter Units.CurrentDensity Aioref = 1.28 "exchange current, for each um of layer";
  inner parameter Units.Pressure poa = 1e5 "pressure of oxygen that jlim belongs to";
  inner parameter Units.TafelSlope B = 0.150 "Tafel slope, natural logarithm";
  inner parameter Units.CurrentDensity jlim = 2400 "limiting current, for each um of layer";
  inner parameter Units.c_diff D1co = 7.853e-7 "Knudsen diffusion of oxygen";
  inner parameter Units.c_diff D2co = 1.047e-6 "Knudsen diffusion of water vapour";
  inner parameter Units.Length rp = 1e-8 "radius of the pores, for ModHyp2 = 1";
  inner parameter Units.c_diff D12o = 2.82e-5 "binary diffusion of oxygen and water vapour at pAref and Tref";
  inner parameter Units.Pressure pAref = 1e5 "pressure of D12o";
  inner parameter Units.Temp_K Tref = 308.1 "temperature of D12o";
  inner parameter Units.factor ModHyp2 = 0 "1: Knudsen diffusion by the radius of the pores" annotation(Evaluate = true);
  inner parameter Units.factor ModHyp1 = 0 "1: double layer" annotation(Evaluate = true);
  inner parameter Units.factor ModHyp3 = 0 "1: protons drag water along" annotation(Evaluate = true);
  inner parameter Units.factor ModHyp4 = 0 "1: conductivity by water and temperature" annotation(Evaluate = true);
  inner parameter Units.factor LSO3 = 14 "water per sulfonic group";
  inner parameter Units.Pressure p_start = 1e5 "oxygen at the start";
  inner parameter Units.Pressure pwg_start = 1e5 "water vapour at the start";
  inner parameter Units.Wload Xs_start = 0 "liquid water per solid at the start";
  inner parameter Boolean frozen = false "gases and liquid stay as they are at the start" annotation(Evaluate = true);
  final inner parameter Units.Pressure psat =
    Basics.saturationPressure(T, posat, Tosat, if corrections.latentHeat then 1.03001e4 else 1.03001e-4, corrections.R)
    "saturation pressure";
  final inner parameter Units.c_diff D1 = if ModHyp2 == 1 then
    4/3*rp*sqrt(2*corrections.R*T/(3.1416*(if corrections.gasTransport then 0.032 else 0.016))) else D1co
    "Knudsen diffusion of oxygen";
  final inner parameter Units.c_diff D2 = if ModHyp2 == 1 then
    4/3*rp*sqrt(2*corrections.R*T/(3.1416*Basics.massh2o)) else D2co "Knudsen diffusion of water vapour";
  final inner parameter Units.volpore Ego = 1 - Es - Ee "pores";
  final inner parameter Units.Wload XsTransport =
    if corrections.waterCapacity then roh2ol/rom*Ego/(Es + Ee) else roh2ol/(ros*Es + rom*Ee)*Ego/Es
    "largest loading, in transport elements";
  final inner parameter Units.Wload XsVolume =
    if corrections.waterCapacity then XsTransport else roh2ol/(ros*Es + rom*Ee)*Ego/(Es + Ee)
    "largest loading, in control volumes";
  Basics.tp_act_mid tp1(node = 2) "from the face to the first control volume";
  mv_act c[n] "control volumes 1 .. n, each with the element to the next";
  Basics.vc_act vc2 "control volume n + 1";
  Basics.tp_act_mid tp2(node = 1) "from the last control volume to the face";
  Basics.vc_act vc1 if not corrections.mesh "the original's control volume on the face";
equation
  connect(exa1, tp1.exa1);
  connect(tp1.exa2, c[1].exa1);
  for k in 1:n - 1 loop
    connect(c[k].exa2, c[k + 1].exa1);
  end for;
  connect(c[n].exa2, vc2.exa1);
  connect(vc2.exa1, tp2.exa1);
  connect(tp2.exa2, exa2);
  connect(exa1, vc1.exa1);
  annotation(Documentation(info = "<html>
<p>face - half element - volume 1 - element - volume 2 - ... - volume n + 1 - half element - face. The
layer is (n + 1) da thick. To refine the mesh of a layer of thickness L set n and da = L/(n + 1).</p>
<p>Aioref, jlim and cdl hold for 1 um of layer, which is the default of da: results do not depend on n.
See <a href=\"modelica://FuelCellLib.Basics.vc_act\">vc_act</a> and
<a href=\"modelica://FuelCellLib.Basics.tp_act\">tp_act</a> for the equations. The numbers are those of
FuelCellLib 1.0, except rp (1e-10 m there, smaller than a molecule).</p>
</html>"));
end act_layer;
