model P
  function tell
    input Real t;
  algorithm
    print("at " + String(t));
  end tell;
  function print
    input String text;
    input String file = "";
    external "C" ModelicaInternal_print(text, file);
  end print;
  Real x(start = 0, fixed = true);
  Real v[400];
equation
  der(x) = 1;
  for i in 1:400 loop
    der(v[i]) = sin(v[i]) * i + cos(time * i);
  end for;
algorithm
  when sample(0.25, 0.25) then
    tell(time);
  end when;
  annotation(experiment(StopTime = 1));
end P;
