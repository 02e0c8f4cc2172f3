// MLS §9.1.3: connections add components to expandable connectors; unconnected ones are left out.
package expandable_connectors
  expandable connector Bus
    Real unused;
  end Bus;
  connector Output = output Real;
  connector Input = input Real;
  model Sensor
    Output speed = 3;
  end Sensor;
  model Actuator
    Input u;
    Real y = 2*u;
  end Actuator;
  model Inside
    Bus bus;
    Actuator actuator;
  equation
    connect(bus.speed, actuator.u);
  end Inside;
  model Main
    Bus bus;
    Sensor sensor;
    Inside inside;
  equation
    connect(sensor.speed, bus.speed);
    connect(bus, inside.bus);
  end Main;
end expandable_connectors;
