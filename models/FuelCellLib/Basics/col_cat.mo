within FuelCellLib.Basics;
model col_cat "Collector of the cathode: what the gas channel holds, and the terminal"
  exac exa1 "layer";
  terminal exa2 "load";
  outer Corrections corrections;
  outer parameter Units.Temp_K T;
  outer parameter Units.Potential Eref;
  outer parameter Units.Pressure pH2;
  Units.Potential Eoc "open circuit voltage";
  parameter Units.Pressure P = 1e5 "pressure of oxygen";
  parameter Units.Pressure PWG = 1e5 "pressure of water vapour";
  parameter Units.Wload XS = 0 "liquid water per solid";
equation
  exa1.p = P;
  exa1.pwg = PWG;
  exa1.Xs = XS;
  exa1.vs = exa2.v;
  exa1.je = exa2.i;
  Eoc = Eref - 0.9e-3*(T - 298) + corrections.R*T/(2*F)*log(pH2/1e5*sqrt(P/1e5)/(PWG/1e5));
  if corrections.ionicCircuit then
    exa1.jp = 0;
  else
    exa1.vs = Eoc + exa1.ve;
  end if;
  annotation(Documentation(info = "<html>
<p>Open circuit voltage by the pressures of the channel (Nernst) and the entropy of the reaction:</p>
<pre>
Eoc = Eref - 0.9e-3 (T - 298) + R T/(2 F) ln[(pH2/1e5) (P/1e5)^(1/2)/(PWG/1e5)]
</pre>
<p>Electrons enter the layer at the rate at which current leaves the terminal; protons do not pass.</p>
</html>"));
end col_cat;
