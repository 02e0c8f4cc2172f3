// MLS §7.3, §9.1, §9.2: connection sets over the whole tree, with redeclaration and loops.
package connections
  connector Pin
    Real v;
    flow Real i;
  end Pin;
  partial model TwoPin
    Pin p, n;
    Real v = p.v - n.v;
  equation
    p.i + n.i = 0;
  end TwoPin;
  model Resistor
    extends TwoPin;
    parameter Real R = 1;
  equation
    v = R*p.i;
  end Resistor;
  model Capacitor
    extends TwoPin;
    parameter Real C = 1;
  equation
    C*der(v) = p.i;
  end Capacitor;
  model Source
    extends TwoPin;
  equation
    v = 1;
  end Source;
  model Ground
    Pin p;
  equation
    p.v = 0;
  end Ground;
  model Pack
    Pin p, n;
    replaceable Resistor r(R = 2) constrainedby TwoPin;
    Resistor rs[3](R = {1, 2, 3});
  equation
    connect(p, r.p);
    connect(r.n, rs[1].p);
    for i in 1:2 loop connect(rs[i].n, rs[i + 1].p); end for;
    connect(rs[3].n, n);
  end Pack;
  model Main
    inner parameter Real T0 = 300;
    Pack pack(redeclare Cond r(G = 0.5));
    Capacitor c(v(start = 0, fixed = true));
    Source s;
    Ground g;
    Probe probe;
  equation
    connect(s.p, pack.p);
    connect(pack.n, c.p);
    connect(c.n, s.n);
    connect(s.n, g.p);
    annotation(experiment(StopTime = 1));
  end Main;
  model Cond
    extends TwoPin;
    parameter Real G = 1;
  equation
    p.i = G*v;
  end Cond;
  model Probe
    outer Real T0;
    Real y = T0 + 1;
  end Probe;
end connections;
