// MLS §9.3.1: a connector has as many flow as potential variables, arrays counted by their sizes
// and overdetermined types by the outputs of `equalityConstraint` (§9.4); §9.1.3: expandable
// connectors have no flow variables of their own.
package connector_sizes
  connector Pin
    Real v;
    flow Real i;
  end Pin;
  connector Plug
    parameter Integer m = 3;
    Pin p[m];
    Real x;
  end Plug;
  type Matrix = Real[3, 3];
  type Orientation
    extends Matrix;
    function equalityConstraint
      input Orientation R1, R2;
      output Real residue[3] = {R1[1, 1], R1[2, 2], R2[1, 1]};
    algorithm
    end equalityConstraint;
  end Orientation;
  connector Frame
    Real r[2];
    Orientation R;
    flow Real f[3];
    flow Real t[3];
  end Frame;
  expandable connector Bus
    Real e;
    flow Real f;
  end Bus;
  model Main
    Plug p;
    Frame f;
    Bus bus;
  end Main;
end connector_sizes;
