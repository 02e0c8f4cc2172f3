within Modelica.Blocks.Math;
block Mean "Mean over one period"
  extends Modelica.Blocks.Interfaces.SISO;
  parameter SI.Frequency f(start = 50) "reciprocal of the period";
  parameter Real x0 = 0 "integral at the start";
  parameter Real y0 = 0 "output during the first period";
  parameter Boolean yGreaterOrEqualZero = false "a negative mean is given as zero";
protected
  parameter SI.Time t0(fixed = false) "time of the start";
  Real x "integral of the input since the beginning of the period";
  discrete Real y_last "mean over the period before";
initial equation
  t0 = time;
  x = x0;
  y_last = y0;
equation
  der(x) = u;
  when sample(t0 + 1/f, 1/f) then
    y_last = if yGreaterOrEqualZero then max(0, f*pre(x)) else f*pre(x);
    reinit(x, 0);
  end when;
  y = y_last;
end Mean;
