model LeadLag
  Real y;
  Real before;
  Real filtered;
  Real u = if time > 2 then 2 else 1;
  Boolean tracks;
  discrete Real begin;
initial equation
  y = 1;
  begin = 10;
equation
  when sample(10, 40) then
    begin = time;
  end when;
  tracks = time >= begin and time < begin + 4;
  if not tracks then
    y = min(3, max(0, before));
    before = 0.5*u + filtered;
    filtered + 2*der(filtered) = 0.5*u;
  else
    y = min(3, max(0, before));
    before = 2;
    filtered + 1e-3*der(filtered) = y - 0.5*u;
  end if;
end LeadLag;
