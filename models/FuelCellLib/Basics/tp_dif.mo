within FuelCellLib.Basics;
model tp_dif "Transport element of a diffusion layer"
  extends PorousTransport;
  outer parameter Units.Conductivity kp;
equation
  exa1.jwl = -ros/massh2o*Dwl*(exa2.Xs - exa1.Xs)/dx;
  exa1.jp = -kp*(exa2.ve - exa1.ve)/dx;
  annotation(Documentation(info = "<html>
<p><code>jwl = -(ros/M) Dwl dXs/dx</code>. The layer hands the potential of the electrolyte on to the
collector, as in the original; no protons flow there when the circuit of the protons is closed.</p>
</html>"));
end tp_dif;
