within Modelica.Blocks;
package Routing "Signals put together and taken apart"
  extends Modelica.Icons.Package;
  import Modelica.Blocks.Interfaces;

  block RealReplicator "A vector of equal signals"
    extends Interfaces.SIMO;
  equation
    y = fill(u, nout);
  end RealReplicator;

  block Replicator = RealReplicator "Name of the block until version 3";

  block IntegerReplicator "A vector of equal integers"
    extends Modelica.Blocks.Icons.IntegerBlock;
    parameter Integer nout = 1 "number of outputs";
    Interfaces.IntegerInput u "input";
    Interfaces.IntegerOutput y[nout] "outputs";
  equation
    y = fill(u, nout);
  end IntegerReplicator;

  block BooleanReplicator "A vector of equal truth values"
    extends Modelica.Blocks.Icons.BooleanBlock;
    parameter Integer nout = 1 "number of outputs";
    Interfaces.BooleanInput u "input";
    Interfaces.BooleanOutput y[nout] "outputs";
  equation
    y = fill(u, nout);
  end BooleanReplicator;

  block RealPassThrough "The input"
    extends Interfaces.SISO;
  equation
    y = u;
  end RealPassThrough;

  block IntegerPassThrough "The input"
    extends Modelica.Blocks.Icons.IntegerBlock;
    Interfaces.IntegerInput u "input";
    Interfaces.IntegerOutput y "output";
  equation
    y = u;
  end IntegerPassThrough;

  block BooleanPassThrough "The input"
    extends Interfaces.BooleanSISO;
  equation
    y = u;
  end BooleanPassThrough;

  block ExtractSignal "Some elements of a vector"
    extends Interfaces.MIMO;
    parameter Integer extract[nout] = 1:nout "indices of the elements" annotation(Evaluate = true);
  equation
    for i in 1:nout loop
      y[i] = u[extract[i]];
    end for;
  end ExtractSignal;

  block Extractor "One element of a vector, chosen while the simulation runs"
    extends Interfaces.MISO;
    parameter Boolean allowOutOfRange = false "an index out of range gives a value";
    parameter Real outOfRangeValue = 1e10 "the value";
    Interfaces.IntegerInput index "index of the element";
  protected
    Real k[nin] "weights: one of the chosen element";
  equation
    assert(allowOutOfRange or index >= 1 and index <= nin, "the index is out of range");
    for i in 1:nin loop
      k[i] = if index == i then 1 else 0;
    end for;
    y = if index >= 1 and index <= nin then k*u else outOfRangeValue;
  end Extractor;

  block Multiplex "A vector of inputs that grows with its connections"
    parameter Integer n(min = 0) = 0 "number of inputs"
      annotation(Dialog(connectorSizing = true), HideResult = true);
    Interfaces.RealVectorInput u[n] "inputs";
    Interfaces.RealOutput y[n] "outputs";
  equation
    y = u;
  end Multiplex;

  block DeMultiplex "A vector of outputs that grows with its connections"
    parameter Integer n(min = 0) = 0 "number of outputs"
      annotation(Dialog(connectorSizing = true), HideResult = true);
    Interfaces.RealInput u[n] "inputs";
    Interfaces.RealVectorOutput y[n] "outputs";
  equation
    y = u;
  end DeMultiplex;

  block Multiplex2 "One vector of two"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n1 = 1 "size of the first vector";
    parameter Integer n2 = 1 "size of the second vector";
    Interfaces.RealInput u1[n1] "first vector";
    Interfaces.RealInput u2[n2] "second vector";
    Interfaces.RealOutput y[n1 + n2] "all elements";
  equation
    y = cat(1, u1, u2);
  end Multiplex2;

  block Multiplex3 "One vector of three"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n1 = 1 "size of the first vector";
    parameter Integer n2 = 1 "size of the second vector";
    parameter Integer n3 = 1 "size of the third vector";
    Interfaces.RealInput u1[n1] "first vector";
    Interfaces.RealInput u2[n2] "second vector";
    Interfaces.RealInput u3[n3] "third vector";
    Interfaces.RealOutput y[n1 + n2 + n3] "all elements";
  equation
    y = cat(1, u1, u2, u3);
  end Multiplex3;

  block Multiplex4 "One vector of four"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n1 = 1 "size of the first vector";
    parameter Integer n2 = 1 "size of the second vector";
    parameter Integer n3 = 1 "size of the third vector";
    parameter Integer n4 = 1 "size of the fourth vector";
    Interfaces.RealInput u1[n1] "first vector";
    Interfaces.RealInput u2[n2] "second vector";
    Interfaces.RealInput u3[n3] "third vector";
    Interfaces.RealInput u4[n4] "fourth vector";
    Interfaces.RealOutput y[n1 + n2 + n3 + n4] "all elements";
  equation
    y = cat(1, u1, u2, u3, u4);
  end Multiplex4;

  block Multiplex5 "One vector of five"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n1 = 1 "size of the first vector";
    parameter Integer n2 = 1 "size of the second vector";
    parameter Integer n3 = 1 "size of the third vector";
    parameter Integer n4 = 1 "size of the fourth vector";
    parameter Integer n5 = 1 "size of the fifth vector";
    Interfaces.RealInput u1[n1] "first vector";
    Interfaces.RealInput u2[n2] "second vector";
    Interfaces.RealInput u3[n3] "third vector";
    Interfaces.RealInput u4[n4] "fourth vector";
    Interfaces.RealInput u5[n5] "fifth vector";
    Interfaces.RealOutput y[n1 + n2 + n3 + n4 + n5] "all elements";
  equation
    y = cat(1, u1, u2, u3, u4, u5);
  end Multiplex5;

  block Multiplex6 "One vector of six"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n1 = 1 "size of the first vector";
    parameter Integer n2 = 1 "size of the second vector";
    parameter Integer n3 = 1 "size of the third vector";
    parameter Integer n4 = 1 "size of the fourth vector";
    parameter Integer n5 = 1 "size of the fifth vector";
    parameter Integer n6 = 1 "size of the sixth vector";
    Interfaces.RealInput u1[n1] "first vector";
    Interfaces.RealInput u2[n2] "second vector";
    Interfaces.RealInput u3[n3] "third vector";
    Interfaces.RealInput u4[n4] "fourth vector";
    Interfaces.RealInput u5[n5] "fifth vector";
    Interfaces.RealInput u6[n6] "sixth vector";
    Interfaces.RealOutput y[n1 + n2 + n3 + n4 + n5 + n6] "all elements";
  equation
    y = cat(1, u1, u2, u3, u4, u5, u6);
  end Multiplex6;

  block DeMultiplex2 "Two vectors of one"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n1 = 1 "size of the first vector";
    parameter Integer n2 = 1 "size of the second vector";
    Interfaces.RealInput u[n1 + n2] "all elements";
    Interfaces.RealOutput y1[n1] "first vector";
    Interfaces.RealOutput y2[n2] "second vector";
  equation
    u = cat(1, y1, y2);
  end DeMultiplex2;

  block DeMultiplex3 "Three vectors of one"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n1 = 1 "size of the first vector";
    parameter Integer n2 = 1 "size of the second vector";
    parameter Integer n3 = 1 "size of the third vector";
    Interfaces.RealInput u[n1 + n2 + n3] "all elements";
    Interfaces.RealOutput y1[n1] "first vector";
    Interfaces.RealOutput y2[n2] "second vector";
    Interfaces.RealOutput y3[n3] "third vector";
  equation
    u = cat(1, y1, y2, y3);
  end DeMultiplex3;

  block DeMultiplex4 "Four vectors of one"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n1 = 1 "size of the first vector";
    parameter Integer n2 = 1 "size of the second vector";
    parameter Integer n3 = 1 "size of the third vector";
    parameter Integer n4 = 1 "size of the fourth vector";
    Interfaces.RealInput u[n1 + n2 + n3 + n4] "all elements";
    Interfaces.RealOutput y1[n1] "first vector";
    Interfaces.RealOutput y2[n2] "second vector";
    Interfaces.RealOutput y3[n3] "third vector";
    Interfaces.RealOutput y4[n4] "fourth vector";
  equation
    u = cat(1, y1, y2, y3, y4);
  end DeMultiplex4;

  block DeMultiplex5 "Five vectors of one"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n1 = 1 "size of the first vector";
    parameter Integer n2 = 1 "size of the second vector";
    parameter Integer n3 = 1 "size of the third vector";
    parameter Integer n4 = 1 "size of the fourth vector";
    parameter Integer n5 = 1 "size of the fifth vector";
    Interfaces.RealInput u[n1 + n2 + n3 + n4 + n5] "all elements";
    Interfaces.RealOutput y1[n1] "first vector";
    Interfaces.RealOutput y2[n2] "second vector";
    Interfaces.RealOutput y3[n3] "third vector";
    Interfaces.RealOutput y4[n4] "fourth vector";
    Interfaces.RealOutput y5[n5] "fifth vector";
  equation
    u = cat(1, y1, y2, y3, y4, y5);
  end DeMultiplex5;

  block DeMultiplex6 "Six vectors of one"
    extends Modelica.Blocks.Icons.Block;
    parameter Integer n1 = 1 "size of the first vector";
    parameter Integer n2 = 1 "size of the second vector";
    parameter Integer n3 = 1 "size of the third vector";
    parameter Integer n4 = 1 "size of the fourth vector";
    parameter Integer n5 = 1 "size of the fifth vector";
    parameter Integer n6 = 1 "size of the sixth vector";
    Interfaces.RealInput u[n1 + n2 + n3 + n4 + n5 + n6] "all elements";
    Interfaces.RealOutput y1[n1] "first vector";
    Interfaces.RealOutput y2[n2] "second vector";
    Interfaces.RealOutput y3[n3] "third vector";
    Interfaces.RealOutput y4[n4] "fourth vector";
    Interfaces.RealOutput y5[n5] "fifth vector";
    Interfaces.RealOutput y6[n6] "sixth vector";
  equation
    u = cat(1, y1, y2, y3, y4, y5, y6);
  end DeMultiplex6;
end Routing;
