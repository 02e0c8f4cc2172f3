package V
type E = enumeration(off, starting, running);
function root
  input Real x;
  input Integer n;
  output Real y;
algorithm
  assert(x > 0, "x = " + String(x, significantDigits = 3) + ", n = " + String(n));
  y := 1;
  for i in 1:n loop y := y*x; end for;
  while y > 1 loop y := y/2; end while;
end root;
function stops
  input Real x;
  output Real y;
algorithm
  y := x;
  while y > 1 loop y := y/2; end while;
  if x > 0.75 then
    Modelica.Utilities.Streams.error("x is " + String(x, format = ".2f"));
  end if;
end stops;
model Warning
  parameter Real p = 0.5;
  parameter Integer width = 8;
  Real x(start = 1, fixed = true);
  E e = if time < 0.75 then E.starting else E.running;
equation
  der(x) = -1;
  assert(x > p, "x = " + String(x, format = ".3f") + ", p = " + String(p, significantDigits = 3)
    + "|" + String(time > 0.1, minimumLength = 6) + "|" + String(p, minimumLength = width,
    leftJustified = false) + "|" + String(e) + "|" + String(e, minimumLength = 9) + "|"
    + (if x > 0.9 then "high" else "low"), AssertionLevel.warning);
end Warning;
model Error
  Real x(start = 1, fixed = true);
  Integer i = integer(4*time);
equation
  der(x) = -1;
  assert(x > 0.5, "x = " + String(x, format = ".2f") + ", i = " + String(i));
end Error;
model AtEvent
  Real x(start = 1, fixed = true);
equation
  der(x) = -1;
  when time > 0.25 then
    Modelica.Utilities.Streams.error("x = " + String(x, format = ".2f"));
  end when;
end AtEvent;
model InFunction
  Real x(start = 1, fixed = true), y = root(x - 0.5, integer(4*time));
equation
  der(x) = -1;
end InFunction;
model Stopped
  Real y = stops(time);
end Stopped;
model Printed
  parameter Real a[2] = {0.5, 1.25};
  parameter String first = "[" + String(a[1]) + "]";
  parameter String names[3] = {String(e) for e in E};
  E e(start = E.off, fixed = true);
algorithm
  when time > 0.5 then
    e := E.running;
    for q in {0.25, 2.75} loop
      Modelica.Utilities.Streams.print(String(q) + " " + String(2*q, significantDigits = 2));
    end for;
    for i in 1:2 loop
      Modelica.Utilities.Streams.print(first + String(i, minimumLength = 3) + " " + names[i]);
    end for;
    Modelica.Utilities.Streams.print(String(e) + " " + String(integer(10*time)));
  end when;
end Printed;
end V;
