package Loads
  model Step "Schritt für Schritt"
    annotation(Icon(Line(points=[-80, -80; 0, -80; 0, 60], style(color=3, rgbcolor={0,0,255}))));
    parameter Real high = 1;
    Real y;
  equation
    y = if time < 0.5 then 0 else high;
    annotation(Documentation(info="<html>µ</html>"));
  equation
    annotation(Diagram);
  end Step;
end Loads;
