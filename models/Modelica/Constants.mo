within Modelica;
package Constants "Constants of mathematics, of the machine and of nature"
  extends Modelica.Icons.Package;

  // Mathematics
  final constant Real e = 2.71828182845904523536 "Euler's number";
  final constant Real pi = 3.14159265358979323846 "Circumference of a circle over its diameter";
  final constant Real D2R(final unit = "rad/deg") = pi/180 "Radians in a degree";
  final constant Real R2D(final unit = "deg/rad") = 180/pi "Degrees in a radian";
  final constant Real gamma = 0.57721566490153286061 "Constant of Euler and Mascheroni";

  // The machine: IEEE 754 numbers of 64 bits, integers of 32 bits
  final constant Real eps = 2.220446049250313e-16 "Smallest number with 1 + eps > 1";
  final constant Real small = 1e-60 "Number that is much smaller than any physical quantity";
  final constant Real inf = 1e60 "Number that is much larger than any physical quantity";
  final constant Integer Integer_inf = 2147483647 "Largest integer";

  // Nature: exact numbers of the SI since 2019, and CODATA 2018
  final constant Units.SI.Velocity c = 299792458 "Speed of light in vacuum";
  final constant Units.SI.Acceleration g_n = 9.80665 "Standard acceleration of gravity";
  final constant Real G(final unit = "m3/(kg.s2)") = 6.67430e-11 "Newton's constant of gravitation";
  final constant Units.SI.ElectricCharge q = 1.602176634e-19 "Charge of an electron, positive";
  final constant Units.SI.FaradayConstant F = 96485.33212331001 "Charge of a mole of electrons, q*N_A";
  final constant Real h(final unit = "J.s") = 6.62607015e-34 "Planck's constant";
  final constant Real k(final unit = "J/K") = 1.380649e-23 "Boltzmann's constant";
  final constant Real R(final unit = "J/(mol.K)") = 8.31446261815324 "Molar gas constant, k*N_A";
  final constant Real sigma(final unit = "W/(m2.K4)") = 2*pi^5*k^4/(15*h^3*c^2)
    "Constant of Stefan and Boltzmann";
  final constant Real N_A(final unit = "1/mol") = 6.02214076e23 "Avogadro's constant";
  final constant Units.SI.Permeability mu_0 = 1.25663706212e-6 "Magnetic constant";
  final constant Units.SI.Permeability mue_0 = mu_0 "Magnetic constant, name until version 3";
  final constant Real epsilon_0(final unit = "F/m") = 1/(mu_0*c*c) "Electric constant";
  final constant Units.NonSI.Temperature_degC T_zero = -273.15 "Absolute zero";
  annotation(Documentation(info = "<html>
<p>The constants of nature are those of the International System of Units since 2019; the magnetic
constant and the constant of gravitation are measured values (CODATA 2018).</p>
</html>"));
end Constants;
