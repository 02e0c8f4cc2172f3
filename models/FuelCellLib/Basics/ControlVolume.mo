within FuelCellLib.Basics;
partial model ControlVolume "Storage of water vapour and liquid water"
  exac exa1(pwg(start = pwg_start, fixed = not frozen), Xs(start = Xs_start, fixed = not frozen)) "all that flows in";
  outer Corrections corrections;
  outer parameter Units.Length da;
  outer parameter Units.Temp_K T;
  outer parameter Units.alfav av;
  outer parameter Units.beta b;
  outer parameter Units.Pressure psat;
  outer parameter Units.volpore Ego;
  outer parameter Units.Wload XsVolume;
  outer parameter Boolean frozen;
  outer parameter Units.Pressure pwg_start;
  outer parameter Units.Wload Xs_start;
  final parameter Real RT(unit = "J/mol") = corrections.R*T "thermal energy";
  final parameter Real sink(unit = "1/s") = if corrections.gasStorage then 0 else 1 "the original's sink";
  final parameter Real rate(unit = "mol/(m3.s.Pa)") =
    if corrections.condensation then av*b/RT else av*b*T/corrections.R "condensation by overpressure";
  Units.volpore Ega "pores without water";
  Units.molarRate condensed(nominal = 1) "condensation";
equation
  Ega = Ego*(1 - exa1.Xs/XsVolume);
  condensed = rate*(exa1.pwg - psat);
  annotation(Documentation(info = "<html>
<p>Water condenses at the rate <code>av b/(R T) (w - psat)</code>. The volume of the pores is what the
liquid leaves: <code>Ega = Ego (1 - Xs/Xsmax)</code>.</p>
<p>With <code>frozen</code> the gases and the liquid stay at their start values: a cell at small
currents, where they have no influence, is then a model of its potentials alone.</p>
</html>"));
end ControlVolume;
