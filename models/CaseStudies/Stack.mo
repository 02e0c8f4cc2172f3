within CaseStudies;
model Stack "Polarization curve of a stack after Amphlett and Mann, by a slow ramp of the current"
  parameter Real xi1(final unit = "V") = -0.9 "activation loss: constant";
  parameter Real xi2(final unit = "V/K") = 3e-3 "activation loss: times T";
  parameter Real xi3(final unit = "V/K") = 7e-5 "activation loss: times T and the logarithm of the oxygen";
  parameter Real xi4(final unit = "V/K") = -1.5e-4 "activation loss: times T and the logarithm of the current";
  parameter Real lambda(final unit = "1", min = 1) = 15 "water of the membrane";
  parameter Real Rc(final unit = "Ohm", min = 0) = 3e-4 "resistance of contacts";
  parameter Units.Voltage B(min = 0) = 0.03 "mass-transport coefficient";
  parameter Integer N = 32 "cells" annotation(Evaluate = true);
  parameter Real A(final unit = "cm2") = 64 "area of a cell" annotation(Evaluate = true);
  parameter Real l(final unit = "cm") = 0.0178 "thickness of the membrane" annotation(Evaluate = true);
  parameter Units.CurrentDensity Jmax = 0.469 "limiting current density" annotation(Evaluate = true);
  parameter Real T(final unit = "K") = 333 "temperature" annotation(Evaluate = true);
  parameter Real pH2(final unit = "atm") = 1 "pressure of hydrogen" annotation(Evaluate = true);
  parameter Real pO2(final unit = "atm") = 0.2095 "pressure of oxygen" annotation(Evaluate = true);
  parameter Real I_max(final unit = "A") = 30 "current at the end of the ramp" annotation(Evaluate = true);
  final parameter Units.Voltage En = 1.229 - 0.85e-3*(T - 298.15) + 4.3085e-5*T*(log(pH2) + 0.5*log(pO2)) "reversible voltage";
  final parameter Real C(final unit = "mol/cm3") = pO2/(5.08e6*exp(-498/T)) "oxygen at the catalyst";
  Real I(final unit = "A") "current";
  Units.CurrentDensity J "current density";
  Real rho(final unit = "Ohm.cm") "resistivity of the membrane";
  output Units.Voltage V "voltage of the stack";
equation
  assert(J < Jmax, "J < Jmax does not hold: the current density reaches its limit");
  assert(lambda > 0.634 + 3*J, "lambda > 0.634 + 3 J does not hold: the membrane does not conduct");
  I = noEvent(max(1e-6, I_max*time));
  J = I/A;
  rho = 181.6*(1 + 0.03*J + 0.062*(T/303)^2*J^2.5)/((lambda - 0.634 - 3*J)*exp(4.18*(T - 303)/T));
  V = N*(En + xi1 + xi2*T + xi3*T*log(C) + xi4*T*log(I) - I*(rho*l/A + Rc) + B*log(1 - J/Jmax));
  annotation(
    experiment(StartTime = 0, StopTime = 1, Interval = 0.002, Tolerance = 1e-6),
    Documentation(info = "<html>
<p>The semi-empirical model that the literature on identification of fuel cells uses, with its seven
parameters, of N equal cells in series:</p>
<pre>
V   = N [En + xi1 + xi2 T + xi3 T ln C + xi4 T ln I - I (rho l/A + Rc) + B ln(1 - J/Jmax)]
En  = 1.229 - 0.85e-3 (T - 298.15) + 4.3085e-5 T (ln pH2 + ln(pO2)/2)
C   = pO2/(5.08e6 exp(-498/T))
rho = 181.6 [1 + 0.03 J + 0.062 (T/303)^2 J^2.5]/[(lambda - 0.634 - 3 J) exp(4.18 (T - 303)/T)]
</pre>
<p>At one temperature and one pressure xi1, xi2 T and xi3 T ln C are one constant: five of the seven
parameters can be identified at most. The sign of xi4 is negative, that of the loss.</p>
<h4>References</h4>
<p>J. C. Amphlett, R. M. Baumert, R. F. Mann, B. A. Peppley, P. R. Roberge, T. J. Harris: Performance
modeling of the Ballard Mark IV solid polymer electrolyte fuel cell. J. Electrochem. Soc. 142 (1995) 1-8.<br>
R. F. Mann, J. C. Amphlett, M. A. I. Hooper, H. M. Jensen, B. A. Peppley, P. R. Roberge: Development and
application of a generalised steady-state electrochemical model for a PEM fuel cell. J. Power Sources 86
(2000) 173-180.</p>
</html>"));
end Stack;
