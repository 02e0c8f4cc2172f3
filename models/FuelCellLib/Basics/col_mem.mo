within FuelCellLib.Basics;
model col_mem "Anode side of the membrane: potential zero"
  exac exa1 "membrane";
  terminal exa2 "load";
  parameter Units.Pressure P = 0 "pressure of oxygen";
  parameter Units.Pressure PWG = 1e5 "pressure of water vapour";
  parameter Units.Wload XS = 0 "liquid water per solid";
equation
  exa1.p = P;
  exa1.pwg = PWG;
  exa1.Xs = XS;
  exa1.vs = exa2.v;
  exa1.ve = 0;
  exa2.v = 0;
  annotation(Documentation(info = "<html>
<p>The anode has no overvoltage: protons start at potential zero, and so does the terminal. What flows
through the terminal as electrons flows into the membrane as protons; nothing has to say so, because
both have to return through the cathode.</p>
</html>"));
end col_mem;
