model P
  function say
    input String text;
    external "C" ModelicaMessage(text);
  end say;
  function f
    input Real x;
    output Real y;
  algorithm
    say("f of " + String(x));
    y := 2*x;
  end f;
  Real y(start = 0, fixed = true);
  Real w(start = 0, fixed = true);
  Real v = w + y/3;
  Real z(start = 0, fixed = true);
  Real u(start = 0, fixed = true);
equation
  der(z) = 1;
  when time > 2 then
    w = 1;
  end when;
algorithm
  when sample(0.25, 0.25) then
    y := if time > 0.3 then f(time) else 3;
    if time > 0.6 then
      u := f(10*time);
    end if;
  end when;
end P;