model Multivibrator "a comparator with positive feedback and a capacitor in its other branch"
  parameter Boolean hasEvents = true "whether the limits of the comparator are events";
  parameter Real a = 100 "amplification";
  Real x(start = 0, fixed = true) "voltage of the capacitor";
  Real v(start = 0.5) "input";
  Real y(start = 1) "output, limited";
equation
  v = y/2 - x;
  if hasEvents then
    y = smooth(0, if a*v > 1 then 1 else if a*v < -1 then -1 else a*v);
  else
    y = smooth(0, noEvent(if a*v > 1 then 1 else if a*v < -1 then -1 else a*v));
  end if;
  der(x) = y - x;
end Multivibrator;
