model StickSlip "a block with Coulomb friction on a moving spring"
  parameter Real m = 1;
  parameter Real c = 1;
  parameter Real Fc = 1 "sliding friction";
  parameter Real Fs = 2 "breakaway force";
  parameter Real u = 1 "speed of the spring";
  Real s(start = 0, fixed = true);
  Real v(start = 0, fixed = true);
  Real force;
  Boolean sliding(start = false, fixed = true);
equation
  force = c*(u*time - s);
  sliding = not pre(sliding) and force > Fs or pre(sliding) and v >= 0;
  der(s) = v;
  m*der(v) = if sliding then force - Fc else 0;
  when not sliding then
    reinit(v, 0);
  end when;
end StickSlip;
