package Circuit "Electrical parts"
  type Voltage = Real(unit = "V", final quantity = "ElectricPotential");
  type Kind = enumeration(linear "Ohm's law", diode);
  connector Pin
    Voltage v;
    flow Real i(unit = "A");
  end Pin;
  function scaled "A multiple"
    input Real u;
    input Real factor = 2 "How often";
    output Real y = u*factor;
  end scaled;
  model Resistor "Ohm's law"
    parameter Real R(unit = "Ohm") = 100 "Resistance";
    parameter Kind kind = Kind.linear;
    Pin p, n;
    Voltage v = p.v - n.v;
  equation
    v = scaled(u = R)*p.i;
    p.i + n.i = 0;
    annotation(Documentation(info = "<html><p>One <b>resistor</b>.</p></html>"));
  end Resistor;
  model Row
    Resistor r[3](each R = 50);
    Resistor last(R = 20, v(start = 1));
  equation
    for i in 1:2 loop
      connect(r[i].n, r[i + 1].p);
    end for;
    connect(r[3].n, last.p);
  end Row;
end Circuit;
