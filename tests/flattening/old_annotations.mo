// Annotations anywhere in a class and more than once, with the graphics of Modelica 1 and 2;
// equations and declarations behind them.
package old_annotations
  annotation(Coordsys(extent=[0, 0; 442, 386], grid=[2, 2], component=[20, 20]),
    Window(x=0.45, y=0.01, width=0.44, height=0.65, library=1, autolayout=1));
  connector Pin
    annotation(Icon(Rectangle(extent=[-98, 20; 8, -82], style(color=0, fillColor=7))));
    Real v;
    flow Real i annotation(Hide=true);
  end Pin;
  model Main
    annotation(Diagram(Line(points=[-90, 0; 40, 0], style(color=0, thickness=2))));
    Pin p annotation(extent=[-120, -20; -80, 20], layer="icon");
    parameter Real R = 2 "resistance" annotation(Dialog(group="a"));
  equation
    p.v = R*p.i + time;
    annotation(Coordsys(extent=[-100, -100; 100, 100]), Documentation(info="one"));
  public
    Real power;
  equation
    power = p.v*p.i;
    annotation(Documentation(info="two"));
  end Main;
end old_annotations;
