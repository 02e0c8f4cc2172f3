package Reactions
  model Chain
    parameter Real k1 = 1;
    parameter Real k2 = 0.1;
    Real a(start = 1, fixed = true);
    Real b(start = 0, fixed = true);
    output Real y = b;
  equation
    der(a) = -k1*a;
    der(b) = k1*a - k2*b;
    annotation(experiment(StopTime = 10, Tolerance = 1e-8));
  end Chain;
end Reactions;
