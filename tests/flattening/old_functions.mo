// Functions of older tools: `ln` is `log`; `RandomUniform` gives numbers from 0 to 1.
model old_functions
  parameter Real Eref = 1.2;
  Real Eoc = Eref + ln(2 + time);
  discrete Real next(start = 0.1, fixed = true);
  discrete Real sig(start = 0, fixed = true);
equation
  when time > pre(next) then
    sig = 1 - pre(sig);
    next = time + RandomUniform(time)/10;
  end when;
end old_functions;
