within FuelCellLib.Basics;
partial model Transport "Element between two points: what flows in on one side flows out on the other"
  exac exa1 "towards the anode";
  exac exa2 "towards the cathode";
  outer Corrections corrections;
  outer parameter Units.Length da;
  outer parameter Units.Temp_K T;
  outer parameter Units.c_diff Dwl;
  outer parameter Units.Density roh2ol;
  parameter Units.factor part = 1 "length of this element, in da" annotation(Evaluate = true);
  parameter Units.factor g1 = 0.5 "weight of exa1 in values of the element" annotation(Evaluate = true);
  final parameter Units.Length dx = part*da "length";
  Units.Wload Xs "liquid water of the element";
  Units.Pressure pwg "vapour of the element";
equation
  Xs = if corrections.mesh then g1*exa1.Xs + (1 - g1)*exa2.Xs elseif noEvent(exa1.jwl > 0) then exa1.Xs else exa2.Xs;
  pwg = if corrections.mesh then g1*exa1.pwg + (1 - g1)*exa2.pwg elseif noEvent(exa1.jwg > 0) then exa1.pwg else exa2.pwg;
  exa1.j + exa2.j = 0;
  exa1.jwg + exa2.jwg = 0;
  exa1.jwl + exa2.jwl = 0;
  exa1.je + exa2.je = 0;
  exa1.jp + exa2.jp = 0;
  annotation(Documentation(info = "<html>
<p>The values of the element are means of both sides; half elements, of which one side is a control
volume and the other the boundary of the layer, have the value of the volume. This is of second order
and has no events. The original takes the side that the flux comes from.</p>
</html>"));
end Transport;
