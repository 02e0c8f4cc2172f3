model Conductor
    Phasor p, n;
    parameter Real G = 1;
  equation
    Connections.branch(p.reference, n.reference);
    p.reference.gamma = n.reference.gamma;
    p.i = G*(p.v - n.v);
    p.i + n.i = 0;
  end Conductor;
  model Sensor
    Phasor p;
    RealOutput gamma = p.reference.gamma;
  equation
    p.i = 0;
  end Sensor;
