within Modelica.Blocks.Math;
block RectifiedMean "Mean of the absolute value over one period"
  extends Modelica.Blocks.Interfaces.SISO;
  parameter SI.Frequency f(start = 50) "reciprocal of the period";
  parameter Real x0 = 0 "integral of the absolute value at the start";
  parameter Real y0(final min = 0) = 0 "output during the first period";
  Abs abs1 "absolute value";
  Mean mean(final f = f, final x0 = x0, final y0 = y0) "its mean";
equation
  connect(u, abs1.u);
  connect(abs1.y, mean.u);
  connect(mean.y, y);
end RectifiedMean;
