model mode_in_algorithm "a Boolean that a relation sets at the start"
  Boolean mode;
  Real e = sin(6*time);
  Integer switches(start = 0, fixed = true);
  discrete Real last(start = 0, fixed = true);
algorithm
  when initial() then
    mode := e >= 0.5;
  end when;
  when e >= 0.5 and mode == false then
    mode := true;
  end when;
  when e <= -0.5 and mode == true then
    mode := false;
  end when;
equation
  when change(mode) then
    switches = pre(switches) + 1;
    last = time;
  end when;
end mode_in_algorithm;
