// MLS §9.4: a type with `equalityConstraint` is redundant by itself; a loop of branches breaks.
package redundant_types
  type Angle
    extends Real;
    function equalityConstraint
      input Angle one;
      input Angle other;
      output Real residue[0];
    algorithm
      assert(abs(one - other) < 1e-10, "the angles differ");
    end equalityConstraint;
  end Angle;
  connector Plug
    Angle theta;
    Real v;
    flow Real i;
  end Plug;
  model Line
    Plug a;
    Plug b;
  equation
    Connections.branch(a.theta, b.theta);
    b.theta = a.theta;
    a.i + b.i = 0;
    a.v - b.v = a.i;
  end Line;
  model Generator
    Plug plug;
  equation
    Connections.root(plug.theta);
    plug.theta = time;
    plug.v = 1;
  end Generator;
  model Main
    Generator generator;
    Line one;
    Line other;
  equation
    connect(generator.plug, one.a);
    connect(one.b, other.a);
    connect(other.b, generator.plug);
  end Main;
end redundant_types;
