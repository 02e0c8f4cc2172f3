package Old "annotations anywhere and more than once"
  annotation(Coordsys(extent = [-100, -100; 100, 100], grid = [2, 2], component = [20, 20]), Window(x = 0.1, y = 0.2));
  model M
    annotation(Icon(Rectangle(extent = [-98, 20; 8, -82], style(color = 0, fillColor = 7))));
    Real x;
    annotation(a = 1);
    Real y;
  protected
    Real z;
    annotation(b = 1);
    Real w;
  equation
    annotation(c = 1);
    x = 1;
    annotation(d = 1);
    y = 2;
    connect(a, b) annotation(points = [-80, 0; -60, 0], style(color = 3));
  algorithm
    z := 1;
    annotation(e = 1);
    w := 2;
  end M;
  annotation(f = 1);
end Old;
