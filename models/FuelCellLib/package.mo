package FuelCellLib "One-dimensional models of the cathode of a PEM fuel cell"
  annotation(
    version = "1.0.0",
    Documentation(info = "<html>
<p>A cut through the plane of a PEM fuel cell, from the anode side of the membrane to the collector of
the cathode: <code>col_mem | membrane | catalytic layer | [diffusion layer] | col_cat</code>, at one
constant temperature. Oxygen, water vapour, liquid water, electrons and protons move through layers
of control volumes (<code>vc_*</code>) and transport elements (<code>tp_*</code>). The kinetics of the
anode are ignored.</p>
<p>Everything is <b>per unit area</b>: the current of a pin is a current density in A/m2, so the
resistance of a load is in Ohm.m2 (1 Ohm.cm2 = 1e-4 Ohm.m2).</p>
<p>Classes, connectors and parameters have the names of the library FuelCellLib 1.0 of M. A. Rubio
(2005), so that scripts that were written for it run; the code is written anew from the equations.
Where the equations of the original are wrong, these are right:
<a href=\"modelica://FuelCellLib.Basics.Corrections\">Corrections</a> lists every correction, with a
switch that turns it off. <code>legacy = true</code> on a case study gives the original's equations.</p>
<h4>References</h4>
<p>M. A. Rubio, A. Urquia, L. Gonzalez, D. Guinea, S. Dormido: FuelCellLib - A Modelica Library for
Modeling of Fuel Cells. Proceedings of the 4th International Modelica Conference, 2005, 75-82.<br>
D. Bevers, M. W&ouml;hr, K. Yasuda, K. Oguro: Simulation of polymer electrolyte fuel cell electrode.
J. Appl. Electrochem. 27 (1997).<br>
K. Broka, P. Ekdunge: Modelling the PEM fuel cell cathode. J. Appl. Electrochem. 27 (1997).<br>
T. E. Springer, T. A. Zawodzinski, S. Gottesfeld: Polymer electrolyte fuel cell model.
J. Electrochem. Soc. 138 (1991) 2334.</p>
</html>"));
end FuelCellLib;
