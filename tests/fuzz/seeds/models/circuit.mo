package Circuit
  connector Pin Real v; flow Real i; end Pin;
  partial model TwoPin Pin p, n; Real u; equation u = p.v - n.v; p.i + n.i = 0; end TwoPin;
  model Resistor extends TwoPin; parameter Real R(min = 0) = 1; equation u = R*p.i; end Resistor;
  model Capacitor extends TwoPin; parameter Real C = 1; equation C*der(u) = p.i; end Capacitor;
  model Source extends TwoPin; equation u = sin(6*time); end Source;
  model Ground Pin p; equation p.v = 0; end Ground;
  model Run
    replaceable model Load = Resistor constrainedby TwoPin;
    Source s; Resistor r(R = 2); Capacitor c[2](each C = 0.1, u(each start = 0)); Ground g; Load load;
  equation
    connect(s.p, r.p); connect(r.n, c[1].p); connect(c[1].n, c[2].p); connect(c[2].n, s.n);
    connect(s.n, g.p); connect(load.p, r.n); connect(load.n, g.p);
  end Run;
end Circuit;
model Run extends Circuit.Run(redeclare model Load = Circuit.Resistor(R = 5)); end Run;
