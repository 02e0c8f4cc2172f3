package Pharma
  partial block Uptake
    Real rate;
  end Uptake;
  block Infusion
    extends Uptake;
  equation
    rate = if time < 1 then 10 else 0;
  end Infusion;
  block Oral
    extends Uptake;
    parameter Real ka = 1;
    Real stock(start = 10, fixed = true);
  equation
    der(stock) = -rate;
    rate = ka*stock;
  end Oral;
  model Patient
    replaceable Infusion uptake constrainedby Uptake;
    parameter Real ke = 0.1;
    parameter Real weight = 1;
    Real c(start = 0, fixed = true);
    output Real y = c;
  equation
    weight*der(c) = uptake.rate - ke*weight*c;
    annotation(experiment(StopTime = 12, Tolerance = 1e-8));
  end Patient;
end Pharma;
