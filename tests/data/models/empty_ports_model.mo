
model EmptyPorts
  connector Port
    parameter Integer m = 0;
    Real x[m];
    Real p;
  end Port;
  parameter Integer n = 0;
  Port port[n](each m = 2);
  Real v[2] = {1, time};
equation
  port.x = fill(v, n);
  port.p = fill(1, n);
  fill(v, n) = port.x;
end EmptyPorts;
