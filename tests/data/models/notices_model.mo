model P
  impure function tell
    input String text;
    input String file = "";
    external "C" ModelicaInternal_print(text, file);
  end tell;
  Real x(start = 0, fixed = true);
  Boolean up(start = false, fixed = true);
  Integer n(start = 0, fixed = true);
equation
  der(x) = 1;
  assert(x < 0.3 or x > 0.6, "x is between", AssertionLevel.warning);
  when initial() then
    tell("start");
  end when;
  when {x > 0.5, x > 0.8} then
    up = true;
    n = pre(n) + 1;
    tell("event " + String(n) + " at " + String(time) + ", up " + String(up));
    assert(x < 0.7, "late: " + String(n), AssertionLevel.warning);
  end when;
algorithm
  when sample(0.25, 0.5) then
    tell("tick");
  end when;
end P;