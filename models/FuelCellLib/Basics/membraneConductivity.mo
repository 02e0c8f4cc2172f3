within FuelCellLib.Basics;
function membraneConductivity "Conductivity of a perfluorosulfonic membrane by its water"
  input Units.factor lambda "water per sulfonic group, mol/mol";
  input Units.Temp_K T "temperature";
  input Boolean corrected "false: the original's expression";
  input Units.Temp_K sign = 1 "of T in the original's 273 + T; its half elements have -1";
  output Units.Conductivity kp "ionic conductivity";
protected
  Real at303 "conductivity at 303 K, in S/cm";
algorithm
  at303 := 0.005139*lambda - 0.00326;
  kp := if corrected then 100*at303*exp(1268*(1/303 - 1/T)) else at303*exp(1268*(1/303 - 1/(273 + sign*T)));
  annotation(Inline = true, Documentation(info = "<html>
<p>Springer et al. 1991, equation 23: (0.005139 lambda - 0.00326) exp(1268 (1/303 - 1/T)) in S/cm.</p>
</html>"));
end membraneConductivity;
