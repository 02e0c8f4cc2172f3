within FuelCellLib.Basics;
record Corrections "Which equations of the original library are corrected"
  parameter Boolean legacy = false "the equations as the original has them" annotation(Evaluate = true);
  parameter Boolean ionicCircuit = not legacy "the protons' circuit is closed" annotation(Evaluate = true);
  parameter Boolean limitSign = not legacy "the limiting current limits" annotation(Evaluate = true);
  parameter Boolean gasStorage = not legacy "no sink of gas in the storage term" annotation(Evaluate = true);
  parameter Boolean productWater = not legacy "water is produced once" annotation(Evaluate = true);
  parameter Boolean condensation = not legacy "rate of condensation by p/(R T)" annotation(Evaluate = true);
  parameter Boolean latentHeat = not legacy "polynomial of the heat of evaporation" annotation(Evaluate = true);
  parameter Boolean gasTransport = not legacy "Stefan-Maxwell and Knudsen diffusion in the pores" annotation(Evaluate = true);
  parameter Boolean waterCapacity = not legacy "largest loading of the catalytic layer" annotation(Evaluate = true);
  parameter Boolean conductivity = not legacy "conductivity of the membrane by its water (ModHyp4)" annotation(Evaluate = true);
  parameter Boolean perVolume = not legacy "kinetics and double layer by volume, not by node" annotation(Evaluate = true);
  parameter Boolean mesh = not legacy "control volumes fill the layer once, face values are means" annotation(Evaluate = true);
  parameter Boolean gasConstant = not legacy "molar gas constant" annotation(Evaluate = true);
  final parameter Units.MolarGasConstant R = if gasConstant then 8.31446 else 8.30824 "molar gas constant"
    annotation(Evaluate = true);
  final parameter Units.Length dref = 1e-6 "thickness of layer that Aioref, jlim and cdl belong to"
    annotation(Evaluate = true);
  annotation(
    defaultComponentName = "corrections",
    defaultComponentPrefixes = "inner",
    missingInnerMessage = "declare `inner FuelCellLib.Basics.Corrections corrections;` in the model",
    Documentation(info = "<html>
<p>An <code>inner</code> component of a cell. All corrections hold by default, none with
<code>legacy = true</code>; each can be chosen alone. What each changes in the voltage is computed in
<code>compat/differences.md</code>.</p>
<table border=\"1\">
<tr><th>switch</th><th>original</th><th>corrected</th></tr>
<tr><td>ionicCircuit</td><td>kinetics by Eoc - vs, <code>jp = -je</code>, cathode collector with
vs = Eoc + ve and any jp: the potential of the electrolyte has no influence</td>
<td>overvoltage Eoc - (vs - ve), <code>jp = je</code> (both are consumed), jp = 0 at the collector</td></tr>
<tr><td>limitSign</td><td>(1 + je/jlim): amplifies</td><td>(1 - i/jlim), i the current of the reaction</td></tr>
<tr><td>gasStorage</td><td>Ego (1 - Xs'/Xsmax) p, a sink p Ego/(R T) without reason</td><td>-Ego Xs'/Xsmax p, the derivative of the pores' volume</td></tr>
<tr><td>productWater</td><td>in the vapour and in the liquid</td><td>in the vapour</td></tr>
<tr><td>condensation</td><td>av b T/R</td><td>av b/(R T)</td></tr>
<tr><td>latentHeat</td><td>1.03001e-4 T in the polynomial: a negative heat at 340 K</td><td>1.03001e4 T; 25.5 kPa at 340 K</td></tr>
<tr><td>gasTransport</td><td>Es in place of the free pores in two terms, D12 proportional to p, 16 g/mol of oxygen</td>
<td>free pores Ega/tau^2 everywhere, D12 inversely proportional to p, 32 g/mol</td></tr>
<tr><td>waterCapacity</td><td>loading by the volume of the solid (and ros)</td><td>(roh2ol/rom) Ego/(Es + Ee)</td></tr>
<tr><td>conductivity</td><td>temperature in degrees and in kelvin mixed up, S/cm taken for S/m</td><td>kelvin, S/m</td></tr>
<tr><td>perVolume</td><td>Aioref, jlim and cdl hold for a node: results depend on n</td><td>for 1 um of layer (dref)</td></tr>
<tr><td>mesh</td><td>a further control volume on the left face; values of elements by the direction of their fluxes</td>
<td>n + 1 control volumes fill the layer; means of both sides, in half elements the value of the volume</td></tr>
<tr><td>gasConstant</td><td>8.30824</td><td>8.31446 J/(mol.K) (CODATA 2018)</td></tr>
</table>
</html>"));
end Corrections;
