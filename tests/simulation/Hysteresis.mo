model Hysteresis "a heater with a two-point controller"
  parameter Real low = 20;
  parameter Real high = 22;
  Real T(start = 18, fixed = true);
  Boolean on(start = true, fixed = true);
  Real heat;
equation
  on = not pre(on) and T < low or pre(on) and T <= high;
  heat = if on then 30 else 10;
  der(T) = heat - T;
end Hysteresis;
