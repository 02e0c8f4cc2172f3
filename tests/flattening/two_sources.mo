// MLS §9.3: the connections of a class join one source of a signal with any number of inputs.
package two_sources
  connector In = input Real;
  connector Out = output Real;
  block Source
    Out y = 1;
  end Source;
  block Sink
    In u;
  end Sink;
  block Through
    In u;
    Out y;
    Source source;
    Sink sink;
  equation
    connect(u, sink.u);
    connect(sink.u, source.y);
    connect(source.y, y);
  end Through;
  model Main
    Source source;
    Through through;
  equation
    connect(source.y, through.u);
  end Main;
end two_sources;
