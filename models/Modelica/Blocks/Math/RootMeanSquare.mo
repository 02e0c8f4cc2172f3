within Modelica.Blocks.Math;
block RootMeanSquare "Root of the mean of the squared input over one period"
  extends Modelica.Blocks.Interfaces.SISO;
  parameter SI.Frequency f(start = 50) "reciprocal of the period";
  parameter Real x0 = 0 "integral of the square at the start";
  parameter Real y0(final min = 0) = 0 "output during the first period";
  Product product "square";
  Mean mean(final f = f, final x0 = x0, final y0 = y0^2, final yGreaterOrEqualZero = true) "mean of the square";
  Sqrt sqrt1 "root";
equation
  connect(u, product.u1);
  connect(u, product.u2);
  connect(product.y, mean.u);
  connect(mean.y, sqrt1.u);
  connect(sqrt1.y, y);
end RootMeanSquare;
