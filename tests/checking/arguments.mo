package arguments "calls with other arguments than the function has"
  function scaled
    input Real u;
    input Real factor = 2;
    output Real y = factor*u;
  end scaled;

  function more
    extends scaled;
    input Real offset = 0;
  end more;

  record Point
    Real x, y;
  end Point;

  function integral
    input Integrand f;
    input Real to;
    output Real y = to*f(to);
  end integral;

  partial function Integrand
    input Real u;
    output Real y;
  end Integrand;

  function applied
    input Real u;
    input Integrand f;
    output Real y;
  algorithm
    y := integral(function scaled(factor = 3), u);
    y := integral(function scaled(fator = 3), u);
    y := scaled();
    y := scaled(u, 2, 3);
    y := scaled(u, factr = 2);
    y := scaled(factor = 2);
    y := more(u, offest = 1);
    y := sin(u, 2) + max();
    y := homotopy(actual = u, simplfied = 2) + noEvent(expression = u);
    y := misspelled(u) + cso(u);
    y := f(u, 1, 2, 3);
  end applied;

  function placed
    output Point p = Point(x = 1, z = 2);
  end placed;

  function typed
    output Integer n;
    output Boolean b = "yes";
  algorithm
    n := "text";
    b := n;
  end typed;
end arguments;
