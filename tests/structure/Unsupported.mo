model Unsupported
  Real x;
  discrete Real y;
equation
  x = time;
  when x > 1 then
    y = 2;
  end when;
end Unsupported;
