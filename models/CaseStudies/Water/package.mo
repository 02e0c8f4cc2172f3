within CaseStudies;
package Water "Layers of a cell in which the membrane takes up water and the pores of the cathode flood"
  import Units = FuelCellLib.Units;
  import F = FuelCellLib.Basics.F;
  import Charge = CaseStudies.Currents.Charge;

  connector Gas "What fills the pores"
    Units.Pressure p(start = 1e5) "oxygen";
    Units.Pressure w(start = 1e4) "water vapour";
    Real s(start = 0, final unit = "1", nominal = 0.1) "saturation: share of the pores that liquid water fills";
    flow Units.molarF jO(nominal = 1e-4) "oxygen";
    flow Units.molarF jW(nominal = 1e-4) "water vapour";
    flow Units.molarF jL(nominal = 1e-4) "liquid water";
  end Gas;

  connector Ionomer "Water of the membrane's material"
    Real lambda(start = 3, final unit = "1", nominal = 10) "water per sulfonic group, mol/mol";
    flow Units.molarF J(nominal = 1e-4) "water";
  end Ionomer;

  record Properties "What all layers of a cell share"
    parameter Integer n(min = 1) = 10 "elements in each layer, which has n + 1 control volumes" annotation(Evaluate = true);
    parameter Units.Temp_K T = 340 "temperature";
    parameter Units.MolarGasConstant R = 8.31446 "molar gas constant" annotation(Evaluate = true);
    parameter Units.Pressure P = 1e5 "oxygen in the channel";
    parameter Units.factor RHc = 0.5 "relative humidity in the channel";
    parameter Units.factor RHa = 1 "relative humidity at the anode";
    parameter Units.c_diff D12 = 5.01e-9 "binary diffusion at Tref";
    parameter Units.Temp_K Tref = 308.1 "temperature of D12";
    parameter Units.factor m = 2 "exponent of the free share of the pores in their diffusion" annotation(Evaluate = true);
    parameter Units.c_diff Kl = 8.5e-13 "diffusion of liquid water in the pores";
    parameter Real kc(final unit = "1/s") = 1e4 "condensation: surface times mass transfer coefficient";
    parameter Units.Density roh2ol = 972 "density of liquid water";
    parameter Units.Density rom = 2000 "density of the membrane";
    parameter Units.MolarMass Mm = 1.1 "mass of the membrane per sulfonic group";
    parameter Units.c_diff Dl = 3e-10 "diffusion of water in the membrane";
    parameter Units.beta ksorb = 1e-7 "sorption of vapour by the ionomer";
    parameter Units.factor lambda0 = 3 "water per sulfonic group at the start";
    final parameter Units.Pressure psat = FuelCellLib.Basics.saturationPressure(T, 3169, 298.16, 1.03001e4, R) "saturation pressure";
    final parameter Real RT(final unit = "J/mol") = R*T "thermal energy";
    final parameter Units.c_diff Db = D12*(T/Tref)^1.5 "binary diffusion";
    final parameter Units.MolarConcentration cw = roh2ol/FuelCellLib.Basics.massh2o "liquid water";
    final parameter Units.MolarConcentration cf = rom/Mm "sulfonic groups in the membrane";
    final parameter Units.molarF kk = cf*ksorb "sorption for a difference of 1 in lambda";
  end Properties;

  function sorption "Water of a membrane in equilibrium with vapour"
    input Units.factor a "activity: vapour pressure by saturation pressure";
    output Units.factor lambda "water per sulfonic group";
  protected
    Real q "activity, at most 1";
  algorithm
    q := 0.5*(a + 1 - sqrt((a - 1)^2 + 1e-4));
    lambda := 0.043 + q*(17.81 + q*(-39.85 + q*36));
    annotation(Inline = true, Documentation(info = "<html>
<p>Springer et al. 1991, equation 16, of an activity that is limited smoothly at 1:
<code>q = (a + 1 - sqrt((a - 1)^2 + 1e-4))/2</code>.</p>
</html>"));
  end sorption;

  function conductivity "Conductivity of the membrane's material at 303 K, S/cm"
    input Units.factor lambda "water per sulfonic group";
    output Real sigma(unit = "S/cm") "conductivity";
  algorithm
    sigma := 0.005139*noEvent(max(lambda, 0.9)) - 0.00326;
    annotation(Inline = true, Documentation(info = "<html>
<p>Springer et al. 1991, equation 23; only ratios of it are used. Limited below 0.9, where the
equation comes near zero.</p>
</html>"));
  end conductivity;
  annotation(Documentation(info = "<html>
<p>Layers in the style of <a href=\"modelica://FuelCellLib.Layer1D\">FuelCellLib.Layer1D</a>: n + 1
control volumes, elements between them, half elements at the faces. Fluxes are positive into a
component, currents are conventional. All parts read an <code>inner Properties properties</code>.</p>
<p>Gases move by Fick's law in a stationary carrier, not by Stefan and Maxwell's equations of oxygen
and vapour alone: with two gases and condensation the Stefan flow feeds the cathode, oxygen could fall
by no more than psat - w, and a flooded cathode would show no effect.</p>
</html>"));
end Water;
