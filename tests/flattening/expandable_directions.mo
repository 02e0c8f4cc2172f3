// MLS §9.1.3: a signal comes into a bus from the block that gives it, through any number of buses.
package expandable_directions
  expandable connector Bus
  end Bus;
  connector In = input Real;
  connector Out = output Real;
  block Sensor
    Out y = time;
  end Sensor;
  block Reader
    In u;
    Real twice = 2*u;
  end Reader;
  model Part
    Bus bus;
    Sensor sensor;
  equation
    connect(sensor.y, bus.x);
  end Part;
  model Main
    Bus bus;
    Part part;
    Reader reader;
  equation
    connect(part.bus, bus);
    connect(bus.x, reader.u);
  end Main;
end expandable_directions;
