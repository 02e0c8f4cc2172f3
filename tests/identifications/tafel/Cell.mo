model Cell "polarization curve by a slow ramp of the current"
  parameter Real A(unit = "V") = 0.05;
  parameter Real R(unit = "Ohm") = 0.2;
  Real i(unit = "A") = 0.005 + time;
  output Real V(unit = "V") = 1.0 - A*log(i/1e-3) - R*i;
equation
  assert(R < 0.5, "the resistance is too large");
  annotation(experiment(StopTime = 1, Interval = 0.0005));
end Cell;
