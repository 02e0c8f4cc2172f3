// MLS §15.2: inStream and actualStream for two, three and through connectors of an instance.
package streams
  connector Port
    Real p;
    flow Real m;
    stream Real h;
  end Port;
  model Source
    parameter Real h0 = 1;
    Port port;
  equation
    port.p = 1;
    port.h = h0;
  end Source;
  model Sink
    Port port;
    Real h_in = inStream(port.h);
    Real h_through = actualStream(port.h);
  equation
    port.m = 1;
    port.h = 0;
  end Sink;
  model Inside
    Port port;
    Sink sink;
  equation
    connect(port, sink.port);
  end Inside;
  model Main
    Source a(h0 = 2);
    Source b(h0 = 3);
    Sink sink;
    Source c;
    Inside inside;
  equation
    connect(a.port, sink.port);
    connect(b.port, sink.port);
    connect(c.port, inside.port);
  end Main;
end streams;
