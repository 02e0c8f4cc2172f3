package modifications "modified elements that are not there"
  model Resistor
    parameter Real R = 1;
    Real v(unit = "V");
    replaceable model Law = Ohm;
  end Resistor;

  model Ohm
    Real r;
  end Ohm;

  partial model Uses
    Resistor one(r = 2, RR = 3);
    Resistor two(v(units = "mV"), R(begin = 2));
    Resistor three(redeclare model Lav = Ohm);
    Resistor four(R = missingValue);
    Real x(strat = 1);
    replaceable Real y(unitt = "V");
    parameter Real p(value = 3) "taken as the value by instantiation";
    Law law(anything = 1);
    replaceable model Law = Ohm;
  end Uses;

  partial model Extended
    extends Resistor(Q = 1, v(quantity = missingQuantity));
  end Extended;

  model Short = Resistor(S = 1);

  type Voltage = Real(unitt = "V");
end modifications;
