// MLS §9.4: a spanning tree decides which connections of redundant records become constraints.
package overconstrained
  record Frame
    Real c;
    Real s;
    function equalityConstraint
      input Frame a;
      input Frame b;
      output Real residue[1];
    algorithm
      residue := {a.s*b.c - a.c*b.s};
    end equalityConstraint;
  end Frame;
  connector Flange
    Frame R;
    Real x;
    flow Real f;
    flow Real t;
  end Flange;
  model Root
    Flange flange;
  equation
    Connections.root(flange.R);
    flange.R = Frame(1, 0);
    flange.x = 0;
  end Root;
  model Bar
    Flange a;
    Flange b;
    Boolean first = Connections.rooted(a.R);
  equation
    Connections.branch(a.R, b.R);
    b.R = a.R;
    b.x = a.x + 1;
    a.f + b.f = 0;
    a.t + b.t = 0;
  end Bar;
  model Spring
    Flange a;
    Flange b;
  equation
    a.f + b.f = 0;
    a.f = a.x - b.x;
    a.t = 0;
    b.t = 0;
    if Connections.isRoot(a.R) then
      a.R = Frame(0, 1);
    end if;
    if Connections.isRoot(b.R) then
      b.R = Frame(0, 1);
    end if;
    Connections.potentialRoot(a.R);
    Connections.potentialRoot(b.R, 5);
  end Spring;
  model Main
    Root root;
    Bar one;
    Bar other;
    Spring spring;
  equation
    connect(root.flange, one.a);
    connect(root.flange, other.a);
    connect(one.b, spring.a);
    connect(other.b, spring.b);
  end Main;
end overconstrained;
