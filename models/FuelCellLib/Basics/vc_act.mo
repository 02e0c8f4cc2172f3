within FuelCellLib.Basics;
model vc_act "Control volume of a catalytic layer"
  extends ControlVolume(exa1(p(start = p_start, fixed = not frozen)));
  outer parameter Units.Pressure p_start;
  outer parameter Units.Density rom;
  outer parameter Units.CurrentDensity Aioref;
  outer parameter Units.TafelSlope B;
  outer parameter Units.CurrentDensity jlim;
  outer parameter Units.Pressure poa;
  outer parameter Units.CapacitanceDensity cdl;
  outer parameter Units.factor ModHyp1;
  outer Units.Potential Eoc;
  final parameter Units.factor share = if corrections.perVolume then da/corrections.dref else 1 "layer in this volume, in dref";
  Units.Potential delta "voltage of the double layer";
  Units.CurrentDensity i "current of the reaction";
  Units.factor drive "exp(overvoltage/B) - 1";
  Units.CurrentDensity jlimR "limiting current at this pressure";
  Units.molarRate oxygen "oxygen that the reaction consumes";
initial equation
  if ModHyp1 == 1 then
    delta = Eoc;
  end if;
equation
  delta = if corrections.ionicCircuit then exa1.vs - exa1.ve else exa1.vs;
  drive = exp((Eoc - delta)/B) - 1;
  jlimR = share*jlim*exa1.p/poa;
  i = if corrections.limitSign then share*Aioref*drive/(1 + share*Aioref*drive/jlimR)
      else share*Aioref*(1 + exa1.je/jlimR)*drive;
  exa1.je = if ModHyp1 == 1 then i - share*cdl*der(delta) else i;
  exa1.jp = if corrections.ionicCircuit then exa1.je else -exa1.je;
  oxygen = (if corrections.mesh then i else exa1.je)/(4*F*da);
  if frozen then
    exa1.p = p_start;
    exa1.pwg = pwg_start;
    exa1.Xs = Xs_start;
  else
    exa1.p/RT*Ego*(sink - der(exa1.Xs)/XsVolume) + Ega/RT*der(exa1.p) = exa1.j/da - oxygen;
    exa1.pwg/RT*Ego*(sink - der(exa1.Xs)/XsVolume) + Ega/RT*der(exa1.pwg) = exa1.jwg/da - condensed + 2*oxygen;
    rom/massh2o*der(exa1.Xs) = exa1.jwl/da + condensed + (if corrections.productWater then 0 else 2*oxygen);
  end if;
  annotation(Documentation(info = "<html>
<p>Oxygen is reduced with the current i per area of layer in this volume (Butler-Volmer without its
anodic half, limited by jlim; B is a Tafel slope for the natural logarithm):</p>
<pre>
i = K (1 - i/jl) (exp((Eoc - delta)/B) - 1),   K = Aioref da/dref,   jl = jlim (da/dref) p/poa
je = jp = i - cdl (da/dref) d(delta)/dt        (the last term with ModHyp1 = 1 only)
delta = vs - ve
</pre>
<p>Balances of oxygen, vapour and liquid water:</p>
<pre>
d(Ega p)/dt/(R T) = j/da - i/(4 F da)
d(Ega w)/dt/(R T) = jwg/da - av b/(R T) (w - psat) + i/(2 F da)
(rom/M) dXs/dt    = jwl/da + av b/(R T) (w - psat)
</pre>
<p>With a double layer, the start is delta = Eoc: an open circuit.</p>
</html>"));
end vc_act;
