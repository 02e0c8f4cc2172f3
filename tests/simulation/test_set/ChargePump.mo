model ChargePump "A transistor with two capacitors under pulses; index 2"
  constant Real VT0 = 0.2; constant Real gamma = 0.035; constant Real phi = 1.01; constant Real COX = 4e-12;
  constant Real Cs = 1.6e-12; constant Real Cd = 0.4e-12;
  constant Real VFB = VT0 - gamma*sqrt(phi) - phi;
  Real QG(nominal = 1e-11) "Charge of the gate";
  Real QS(nominal = 1e-11); Real QD(nominal = 1e-11);
  Real v "Voltage at the gate"; Real vs(start = 0, fixed = true, nominal = 1); Real vd(start = 0, fixed = true, nominal = 1);
  Real i(nominal = 1e-3) "Current of the source";
  Real phase(start = 0); Real ugs; Real ugd; Real ubs; Real vte; Real ugst; Real ugdt;
  Integer period(start = 0, fixed = true);
equation
  when sample(120e-9, 120e-9) then
    period = pre(period) + 1;
  end when;
  phase = time*1e9 - 120*period;
  v = if phase < 50 then 0 elseif phase < 60 then 2*(phase - 50) elseif phase < 110 then 20 else 2*(120 - phase);
  ugs = if vd < vs then v - vd else v - vs;
  ugd = if vd < vs then v - vs else v - vd;
  ubs = ugs - v;
  vte = VT0 + gamma*(sqrt(phi - ubs) - sqrt(phi));
  ugst = ugs - vte;
  ugdt = if ugd > vte then ugd - vte else 0;
  QG = if v <= VFB then COX*(v - VFB) elseif ugs <= vte then COX*gamma*(sqrt((gamma/2)^2 + v - VFB) - gamma/2)
    else COX*(2/3*(ugdt + ugst - ugdt*ugst/(ugdt + ugst)) + gamma*sqrt(phi - ubs));
  QS = if v <= VFB or ugs <= vte then 0 else -COX/3*(ugdt + ugst - ugdt*ugst/(ugdt + ugst));
  QD = QS;
  i = -der(QG);
  Cs*der(vs) + der(QS) = 0;
  Cd*der(vd) + der(QD) = 0;
end ChargePump;
