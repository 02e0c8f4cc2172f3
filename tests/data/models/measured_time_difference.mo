package P
  type Difference = Real(final quantity = "ThermodynamicTemperature", final unit = "K")
    annotation(absoluteValue = false);
  type Rise = Difference(min = 0);
  model Heater
    parameter Real P(unit = "K") = 5;
    parameter Real k(unit = "1/s") = 0.1;
    Rise dT(start = 0, fixed = true);
    Real rise(unit = "K") = dT annotation(absoluteValue = false);
    Real T(unit = "K") = 293.15 + dT;
  equation
    der(dT) = k*(P - dT);
  end Heater;
end P;
