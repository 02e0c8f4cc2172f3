model Plant
  Lib.Resistor r(R = 2);
  Lib.Voltage v = Lib.f(3)*r.i;
  Lib.Pump pump(speed = 4);
  Lib.Tank tank(height = 3, area = 1);
  Lib.Valve valve(old = 1, kept = 2);
  Lib.Gone gone;
  Lib.Sink one(kind = 1), two(kind = 2);
  replaceable Lib.Resistor s constrainedby Lib.Resistor.Base;
equation
  v = pump.speed + tank.height;
end Plant;
