// `Connections.uniqueRoot` and `uniqueRootIndices` of Modelica_StateGraph2: the steps of a parallel part
// of a state graph are reached from one entry each, and its exits say from which.
package unique_roots
  record Node
    Integer n;
    function equalityConstraint
      input Node one;
      input Node other;
      output Real residue[0];
    algorithm
      for i in 1:0 loop
        residue[i] := 0;
      end for;
    end equalityConstraint;
  end Node;
  connector Port
    Node node;
    Boolean b;
  end Port;
  model Step
    Port inPort;
    Port outPort;
  equation
    Connections.branch(inPort.node, outPort.node);
    outPort.node = inPort.node;
    outPort.b = inPort.b;
  end Step;
  model Parallel
    Port entry[3];
    Port exit[2];
    Integer indices[3];
  equation
    Connections.uniqueRoot(entry.node, "two branches are connected");
    indices = Connections.uniqueRootIndices(entry.node, exit.node, message = "an exit has no entry");
    for i in 1:3 loop
      entry[i].node.n = i;
      entry[i].b = false;
    end for;
  end Parallel;
  model Main
    Parallel p;
    Step one, two, three;
  equation
    connect(p.entry[1], one.inPort);
    connect(one.outPort, p.exit[2]);
    connect(p.entry[2], two.inPort);
    connect(p.entry[3], three.inPort);
    connect(three.outPort, p.exit[1]);
  end Main;
end unique_roots;
