model resistance
  parameter Real R = 2;
  Real u;
  Real i;
equation
  u = R*i;
end resistance;

model twice
  extends resistance(R = 4);
end twice;
