package members "elements that components and packages do not have"
  connector Pin
    Real v;
    flow Real i;
  end Pin;

  package Numbers
    constant Real one = 1;
    type Kind = enumeration(linear, square);
    function half
      input Real u;
      output Real y = u/2;
    end half;
  end Numbers;

  partial package Medium
    replaceable record State
      Real p;
    end State;
  end Medium;

  package Air
    extends Medium;
    redeclare record extends State
      Real T;
    end State;
    function pressure
      input State state;
      output Real p = state.p + state.q + state.T;
      output State other = State(p = 1, T = 2, X = 3);
    end pressure;
  end Air;

  partial model Part
    Pin p, n[2];
    outer Pin ground;
    Numbers.Kind kind = Numbers.Kind.cubic;
    Real x = Numbers.two;
  equation
    p.u = 0;
    n[1].j = p.i.k;
    x = Numbers.third(x);
    connect(p, ground.q);
    x = Numbers.Functions.half(x);
  end Part;
end members;
