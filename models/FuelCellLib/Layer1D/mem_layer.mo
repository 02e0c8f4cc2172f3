within FuelCellLib.Layer1D;
model mem_layer "Membrane"
  Basics.exac exa1 "towards the anode";
  Basics.exac exa2 "towards the cathode";
  outer Basics.Corrections corrections;
  parameter Integer n(min = 1) = 10 "elements: the layer has n + 1 control volumes" annotation(Evaluate = true);
  inner parameter Units.Temp_K T = 340 "temperature";
  inner parameter Units.alfav av = 1e-9 "surface of condensation per volume";
  inner parameter Units.beta b = 1e-3 "mass transfer coefficient of condensation";
  inner parameter Units.Length da = 1e-5 "thickness of an element: the layer has (n + 1) da";
  inner parameter Units.volpore Ee = 0.72 "electrolyte fraction";
  inner parameter Units.factor tau = 1 "tortuosity";
  inner parameter Units.c_diff Dwl = 1e-8 "diffusion of liquid water";
  inner parameter Units.c_diff D2 = 1e-6 "diffusion of water vapour";
  inner parameter Units.Conductivity kpo = 1 "ionic conductivity";
  inner parameter Units.Pressure posat = 3169 "saturation pressure at Tosat";
  inner parameter Units.Temp_K Tosat = 298.16 "temperature of posat";
  inner parameter Units.Density roh2ol = 972 "density of liquid water";
  inner parameter Units.Density rom = 2000 "density of the electrolyte";
  inner parameter Units.MolarMass Mm = 1.1 "mass of the electrolyte per sulfonic group";
  inner parameter Units.factor ModHyp3 = 0 "1: protons drag water along" annotation(Evaluate = true);
  inner parameter Units.factor ModHyp4 = 0 "1: conductivity by water and temperature" annotation(Evaluate = true);
  inner parameter Units.factor LSO3 = 14 "water per sulfonic group";
  inner parameter Units.Pressure pwg_start = 1e5 "water vapour at the start";
  inner parameter Units.Wload Xs_start = 0 "liquid water per solid at the start";
  inner parameter Boolean frozen = false "gases and liquid stay as they are at the start" annotation(Evaluate = true);
  final inner parameter Units.Pressure psat =
    Basics.saturationPressure(T, posat, Tosat, if corrections.latentHeat then 1.03001e4 else 1.03001e-4, corrections.R)
    "saturation pressure";
  final inner parameter Units.volpore Ego = 1 - Ee "pores";
  final inner parameter Units.Wload XsTransport = roh2ol/rom*Ego/Ee "largest loading";
  final inner parameter Units.Wload XsVolume = XsTransport "largest loading";
  Basics.tp_mem_mid tp1(node = 2) "from the face to the first control volume";
  mv_mem c[n] "control volumes 1 .. n, each with the element to the next";
  Basics.vc_mem vc2 "control volume n + 1";
  Basics.tp_mem_mid tp2(node = 1) "from the last control volume to the face";
equation
  connect(exa1, tp1.exa1);
  connect(tp1.exa2, c[1].exa1);
  for k in 1:n - 1 loop
    connect(c[k].exa2, c[k + 1].exa1);
  end for;
  connect(c[n].exa2, vc2.exa1);
  connect(vc2.exa1, tp2.exa1);
  connect(tp2.exa2, exa2);
  annotation(Documentation(info = "<html>
<p>face - half element - volume 1 - element - volume 2 - ... - volume n + 1 - half element - face. The
layer is (n + 1) da thick. To refine the mesh of a layer of thickness L set n and da = L/(n + 1).</p>
<p>See <a href=\"modelica://FuelCellLib.Basics.vc_mem\">vc_mem</a> and
<a href=\"modelica://FuelCellLib.Basics.tp_mem\">tp_mem</a> for the equations. The numbers are those of
FuelCellLib 1.0.</p>
</html>"));
end mem_layer;
