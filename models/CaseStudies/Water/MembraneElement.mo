within CaseStudies.Water;
model MembraneElement "Water and protons between two points of a membrane"
  Ionomer water1 "towards the anode";
  Ionomer water2 "towards the cathode";
  FuelCellLib.Basics.terminal ion1 "towards the anode";
  FuelCellLib.Basics.terminal ion2 "towards the cathode";
  outer Properties properties;
  outer parameter Units.Length h;
  outer parameter Units.AreaResistance Rmem;
  parameter Units.factor g1 = 0.5 "length on the side of water1, in h" annotation(Evaluate = true);
  parameter Units.factor g2 = 0.5 "length on the side of water2, in h" annotation(Evaluate = true);
  Units.AreaResistance Rm "resistance";
protected
  Units.factor lambda "water per sulfonic group";
equation
  lambda = (g1*water1.lambda + g2*water2.lambda)/(g1 + g2);
  water1.J = -properties.cf*properties.Dl*(water2.lambda - water1.lambda)/((g1 + g2)*h) + 2.5/22*lambda*ion1.i/F;
  water1.J + water2.J = 0;
  Rm = Rmem/(properties.n + 1)*conductivity(properties.lambda0)*
    ((if g1 > 0 then g1/conductivity(water1.lambda) else 0) + (if g2 > 0 then g2/conductivity(water2.lambda) else 0));
  ion1.v - ion2.v = Rm*ion1.i;
  ion1.i + ion2.i = 0;
  annotation(Documentation(info = "<html>
<p>Diffusion and electro-osmotic drag (Springer et al. 1991), and resistance. Rmem is the resistance of
the whole membrane at lambda0: the conductivity gives its ratio, Rmem its size.</p>
<pre>
J  = -cf Dl dlambda/dx + (2.5 lambda/22) i/F
Rm = Rmem/N sum_k sigma(lambda0)/sigma(lambda_k)
</pre>
</html>"));
end MembraneElement;
