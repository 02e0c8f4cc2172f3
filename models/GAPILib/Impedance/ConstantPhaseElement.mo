within GAPILib.Impedance;
block ConstantPhaseElement "Impedance 1/(Q s^alpha): a distributed capacitance, or with alpha = 0.5 diffusion"
  input Real i(unit = "A") "current";
  output Real v(unit = "V") "voltage";
  parameter Real Q(min = 0) = 1 "admittance at 1 rad/s, S.s^alpha";
  parameter Real alpha(min = 0, max = 1) = 0.8 "exponent, above 0 and at most 1";
  parameter Real fMin(unit = "Hz") = 1e-3 "lowest frequency of use" annotation(Evaluate = true);
  parameter Real fMax(unit = "Hz") = 1e5 "highest frequency of use" annotation(Evaluate = true);
protected
  constant Real pi = 3.141592653589793;
  constant Real h = log(10)/5 "distance of the time constants by their logarithm";
  constant Real margin = 10^3.5 "how far the time constants go beyond the frequencies of use";
  final parameter Integer n = integer(ceil(log(margin^2*fMax/fMin)/h)) + 1 "number of time constants";
  final parameter Real x[n] = {2*pi*fMin/margin*exp((k - 1)*h) for k in 1:n} "their inverses, rad/s";
  final parameter Real w[n] = {sin(alpha*pi)/pi*h/Q*x[k]^(-alpha) for k in 1:n} "resistances";
  // What lies beyond, as a geometric series each: one relaxation with the same first two moments.
  final parameter Real below = exp(-h*(1 - alpha)) "ratio of neighbouring terms of R x";
  final parameter Real below2 = exp(-h*(2 - alpha)) "the same of R x^2";
  // sin(alpha pi) and the series vanish together where alpha is 0 or 1.
  final parameter Real slow = (if 1 - alpha < 1e-9 then pi/h else sin(alpha*pi)/(1 - below)) "limit included";
  final parameter Real fast = (if alpha < 1e-9 then pi/h else sin(alpha*pi)/(1 - above)) "limit included";
  final parameter Real g = slow/pi*h/Q*x[1]^(1 - alpha)*below "sum of R x of the slow ones";
  final parameter Real xSlow = x[1]*below2/(1 - below2)*(1 - below)/below "their mean inverse";
  final parameter Real above = exp(-h*alpha) "ratio of neighbouring terms of R";
  final parameter Real above2 = exp(-h*(1 + alpha)) "the same of R/x";
  final parameter Real wFast = fast/pi*h/Q*x[n]^(-alpha)*above "sum of R of the fast ones";
  final parameter Real xFast = x[n]*above*(1 - above2)/((1 - above)*above2) "their mean inverse, infinite for alpha = 0";
  Real u[n](each start = 0, each fixed = true, each unit = "V") "voltages of the relaxations";
  Real uSlow(start = 0, fixed = true, unit = "V") "voltage of all slower ones";
  Real uFast(start = 0, fixed = true, unit = "V") "voltage of all faster ones";
equation
  for k in 1:n loop
    der(u[k]) = x[k]*(w[k]*i - u[k]);
  end for;
  der(uSlow) = g*i - xSlow*uSlow;
  der(uFast) = xFast*(wFast*i - uFast);
  v = sum(u) + uSlow + uFast;
  annotation(Documentation(info = "<html>
<p>The integral representation of the power,</p>
<pre>s^(-alpha) = sin(pi alpha)/pi * integral of exp(-alpha t)/(1 + s exp(-t)) dt,</pre>
<p>by the trapezoidal rule with five time constants in a decade, three and a half decades beyond the frequencies
of use on both sides, and one more relaxation for all that is slower and one for all that is faster. Between
<code>fMin</code> and <code>fMax</code> the impedance differs from the formula by less than 1e-8 of its magnitude
for exponents from 0.1 to 0.95.</p>
</html>"));
end ConstantPhaseElement;
