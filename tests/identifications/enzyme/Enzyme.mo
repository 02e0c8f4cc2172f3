within ;
package Cinetique
  model Enzyme "vitesse sur la concentration, qui monte lentement"
    parameter Real Vmax = 1;
    parameter Real Km = 1;
    Real S = 0.01 + time;
    output Real v = Vmax*S/(Km + S);
    annotation(experiment(StopTime = 10, Interval = 0.01));
  end Enzyme;
end Cinetique;
