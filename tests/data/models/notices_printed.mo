model W
  impure function tell
    input String text;
    input String file;
    external "C" ModelicaInternal_print(text, file);
  end tell;
  parameter String file = "log.txt";
  parameter String separator = ";";
  Real u = 2*time;
  Integer n(start = 0, fixed = true);
  Boolean late = time > 0.75;
algorithm
  when sample(0, 0.5) then
    n := pre(n) + 1234567;
    tell(String(time) + separator + String(u/3, significantDigits = 3) + separator + String(n)
      + separator + String(late, minimumLength = 6) + separator + String(u, format = "8.3f"), file);
  end when;
equation
  when time > 0.25 then
    tell("u is " + String(u/3, significantDigits = 10), "other.txt");
  end when;
end W;
