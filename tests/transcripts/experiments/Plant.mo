package Plant "Small models with known solutions"
  model Decay "x = x0 exp(-k t)"
    parameter Real k = 1 "rate";
    Real x(start = 1, fixed = true);
  equation
    der(x) = -k*x;
  end Decay;

  model Chain "n decays in a row"
    parameter Integer n = 2;
    Real x[n](start = fill(1, n), each fixed = true);
  equation
    der(x) = -x;
  end Chain;

  model Oscillator "x = x0 cos(w t)"
    parameter Real w = 2;
    Real x(start = 1, fixed = true);
    Real v(start = 0, fixed = true);
  equation
    der(x) = v;
    der(v) = -w^2*x;
    annotation(experiment(StopTime = 3.0, Tolerance = 1e-8));
  end Oscillator;

  model Lag "first order, with feedthrough"
    parameter Real T = 0.5;
    input Real u;
    output Real y = x + 2*u;
    Real x(start = 0, fixed = true);
  equation
    T*der(x) = u - x;
  end Lag;

  model Guarded "a state that only the model sees, and what others see of it"
    parameter Real k = 2;
    output Real y = 3*x;
    Real z = y + x;
  protected
    Real x(start = 1, fixed = true);
  equation
    der(x) = -k*x;
  end Guarded;
end Plant;
