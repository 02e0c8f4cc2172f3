encapsulated package Cells "A library written for Modelica 2"
  annotation(Coordsys(extent=[0, 0; 442, 386], grid=[2, 2], component=[20, 20]),
    Window(x=0.45, y=0.01, width=0.44, height=0.65, library=1, autolayout=1));
  constant Real F = 96485 "Faraday's constant";
  annotation(Icon(Rectangle(extent=[-98, 20; 8, -82], style(color=0, fillColor=8, fillPattern=1))));
end Cells;
