connector ComplexOutput = output Complex;
  function fromPolar
    input Real length;
    input Real phi;
    output Complex c(re = length*cos(phi), im = length*sin(phi));
  end fromPolar;
  block Phases
    RealInput u;
    ComplexOutput y[3] = fromPolar(fill(u, 3), {0, 2, 4});
  end Phases;
  block Equations
    RealInput u;
    ComplexOutput y[3];
  equation
    y = fromPolar(fill(u, 3), {0, 2, 4});
  end Equations;
  model Source
    parameter Boolean useInput = false;
    Pin p;
    RealInput i_in = i if useInput;
    Real i;
  equation
    if not useInput then
      i = 1;
    end if;
    p.i = -i;
  end Source;
  block Clock
    RealOutput y = time;
  end Clock;
  model Ground
    Pin p;
  equation
    p.v = 0;
  end Ground;
  model Complete
    Phases a(u = time);
    Equations b(u = time);
    Clock clock;
    Source fixed, given(useInput = true);
    Ground one, other;
  equation
    connect(clock.y, given.i_in);
    connect(fixed.p, one.p);
    connect(given.p, other.p);
  end Complete;
