model Step
  annotation(Coordsys(extent=[-100, -100; 100, 100]));
  Real y;
equation
  y = if time < 0.5 then 0 else 1;
end Step;
