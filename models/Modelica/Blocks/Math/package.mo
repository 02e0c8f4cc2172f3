within Modelica.Blocks;
package Math "Arithmetic and functions"
  extends Modelica.Icons.Package;
  import Modelica.Blocks.Interfaces;

  block InverseBlockConstraints "Two connections that make an inverse of what lies between them"
    Interfaces.RealInput u1 "first input";
    Interfaces.RealInput u2 "second input";
    Interfaces.RealOutput y1 "first output";
    Interfaces.RealOutput y2 "second output";
  equation
    u1 = u2;
    y1 = y2;
  end InverseBlockConstraints;

  block Gain "k u"
    parameter Real k(start = 1) "factor";
    Interfaces.RealInput u "input";
    Interfaces.RealOutput y "output";
  equation
    y = k*u;
  end Gain;

  block MatrixGain "K u"
    parameter Real K[:, :] = [1, 0; 0, 1] "matrix";
    extends Interfaces.MIMO(final nin = size(K, 2), final nout = size(K, 1));
  equation
    y = K*u;
  end MatrixGain;

  block MultiSum "Sum of weighted inputs"
    extends Interfaces.PartialRealMISO;
    parameter Real k[nu] = fill(1, nu) "weights";
  equation
    y = if nu > 0 then k*u else 0;
  end MultiSum;

  block MultiProduct "Product of the inputs"
    extends Interfaces.PartialRealMISO;
  equation
    y = if nu > 0 then product(u) else 0;
  end MultiProduct;

  block Sum "Sum of weighted inputs"
    extends Interfaces.MISO;
    parameter Real k[nin] = ones(nin) "weights";
  equation
    y = k*u;
  end Sum;

  block Feedback "Difference of a command and a feedback"
    Interfaces.RealInput u1 "command";
    Interfaces.RealInput u2 "feedback";
    Interfaces.RealOutput y "difference";
  equation
    y = u1 - u2;
  end Feedback;

  block Add "k1 u1 + k2 u2"
    extends Interfaces.SI2SO;
    parameter Real k1 = +1 "weight of the first input";
    parameter Real k2 = +1 "weight of the second input";
  equation
    y = k1*u1 + k2*u2;
  end Add;

  block Add3 "k1 u1 + k2 u2 + k3 u3"
    parameter Real k1 = +1 "weight of the first input";
    parameter Real k2 = +1 "weight of the second input";
    parameter Real k3 = +1 "weight of the third input";
    Interfaces.RealInput u1 "first input";
    Interfaces.RealInput u2 "second input";
    Interfaces.RealInput u3 "third input";
    Interfaces.RealOutput y "sum";
  equation
    y = k1*u1 + k2*u2 + k3*u3;
  end Add3;

  block Product "u1 u2"
    extends Interfaces.SI2SO;
  equation
    y = u1*u2;
  end Product;

  block Division "u1/u2"
    extends Interfaces.SI2SO;
  equation
    y = u1/u2;
  end Division;

  block Abs "Absolute value"
    extends Interfaces.SISO;
    parameter Boolean generateEvent = false "a change of the sign is an event";
  equation
    y = if generateEvent then (if u >= 0 then u else -u) else noEvent(if u >= 0 then u else -u);
  end Abs;

  block Sign "Sign: -1, 0 or 1"
    extends Interfaces.SISO;
    parameter Boolean generateEvent = false "a change of the sign is an event";
  equation
    y = if generateEvent then (if u > 0 then 1 elseif u < 0 then -1 else 0)
      else noEvent(if u > 0 then 1 elseif u < 0 then -1 else 0);
  end Sign;

  block Sqrt "Square root"
    extends Interfaces.SISO;
  equation
    y = sqrt(u);
  end Sqrt;

  block Sin "Sine"
    extends Interfaces.SISO(u(unit = "rad"));
  equation
    y = sin(u);
  end Sin;

  block Cos "Cosine"
    extends Interfaces.SISO(u(unit = "rad"));
  equation
    y = cos(u);
  end Cos;

  block Tan "Tangent"
    extends Interfaces.SISO(u(unit = "rad"));
  equation
    y = tan(u);
  end Tan;

  block Asin "Angle of a sine"
    extends Interfaces.SISO(y(unit = "rad"));
  equation
    y = asin(u);
  end Asin;

  block Acos "Angle of a cosine"
    extends Interfaces.SISO(y(unit = "rad"));
  equation
    y = acos(u);
  end Acos;

  block Atan "Angle of a tangent"
    extends Interfaces.SISO(y(unit = "rad"));
  equation
    y = atan(u);
  end Atan;

  block Atan2 "Angle of the point (u2, u1)"
    extends Interfaces.SI2SO(y(unit = "rad"));
  equation
    y = atan2(u1, u2);
  end Atan2;

  block Sinh "Hyperbolic sine"
    extends Interfaces.SISO;
  equation
    y = sinh(u);
  end Sinh;

  block Cosh "Hyperbolic cosine"
    extends Interfaces.SISO;
  equation
    y = cosh(u);
  end Cosh;

  block Tanh "Hyperbolic tangent"
    extends Interfaces.SISO;
  equation
    y = tanh(u);
  end Tanh;

  block Exp "Exponential function"
    extends Interfaces.SISO;
  equation
    y = exp(u);
  end Exp;

  block Power "A number to the power of the input"
    extends Interfaces.SISO;
    parameter Real base = Modelica.Constants.e "the number";
    parameter Boolean useExp = true "computed with the exponential function";
  equation
    y = if useExp then exp(u*log(base)) else base^u;
  end Power;

  block Exponentiation "The input to the power of a number"
    extends Interfaces.SISO;
    parameter Real exponent = 2 "the number";
  equation
    y = u^exponent;
  end Exponentiation;

  block Log "Logarithm"
    extends Interfaces.SISO;
    parameter Real base = Modelica.Constants.e "its base";
  equation
    y = log(u)/log(base);
  end Log;

  block Log10 "Logarithm to the base of 10"
    extends Interfaces.SISO;
  equation
    y = log10(u);
  end Log10;

  block WrapAngle "The same angle in a range of one turn"
    extends Interfaces.SISO(u(unit = "rad"), y(unit = "rad"));
    parameter Boolean positiveRange = false "0 <= y < 2 pi, else -pi < y <= pi";
  equation
    y = Modelica.Math.wrapAngle(u, positiveRange);
  end WrapAngle;

  block RealToInteger "The nearest integer"
    extends Modelica.Blocks.Icons.IntegerBlock;
    Interfaces.RealInput u "input";
    Interfaces.IntegerOutput y "output";
  equation
    y = if u > 0 then integer(floor(u + 0.5)) else integer(ceil(u - 0.5));
  end RealToInteger;

  block IntegerToReal "An integer as a real number"
    Interfaces.IntegerInput u "input";
    Interfaces.RealOutput y "output";
  equation
    y = u;
  end IntegerToReal;

  block BooleanToReal "One of two real numbers"
    extends Interfaces.partialBooleanSI;
    parameter Real realTrue = 1.0 "output if the input is true";
    parameter Real realFalse = 0.0 "output if it is false";
    Interfaces.RealOutput y "output";
  equation
    y = if u then realTrue else realFalse;
  end BooleanToReal;

  block BooleanToInteger "One of two integers"
    extends Interfaces.partialBooleanSI;
    parameter Integer integerTrue = 1 "output if the input is true";
    parameter Integer integerFalse = 0 "output if it is false";
    Interfaces.IntegerOutput y "output";
  equation
    y = if u then integerTrue else integerFalse;
  end BooleanToInteger;

  block RealToBoolean "Whether a threshold is reached"
    Interfaces.RealInput u "input";
    extends Interfaces.partialBooleanSO;
    parameter Real threshold = 0.5 "smallest input that gives true";
  equation
    y = u >= threshold;
  end RealToBoolean;

  block IntegerToBoolean "Whether a threshold is reached"
    Interfaces.IntegerInput u "input";
    extends Interfaces.partialBooleanSO;
    parameter Integer threshold = 1 "smallest input that gives true";
  equation
    y = u >= threshold;
  end IntegerToBoolean;

  block RectangularToPolar "Length and angle of a vector of the plane"
    Interfaces.RealInput u_re "first component";
    Interfaces.RealInput u_im "second component";
    Interfaces.RealOutput y_abs "length";
    Interfaces.RealOutput y_arg(unit = "rad") "angle";
  equation
    y_abs = sqrt(u_re*u_re + u_im*u_im);
    y_arg = atan2(u_im, u_re);
  end RectangularToPolar;

  block PolarToRectangular "Components of a vector of the plane"
    Interfaces.RealInput u_abs "length";
    Interfaces.RealInput u_arg(unit = "rad") "angle";
    Interfaces.RealOutput y_re "first component";
    Interfaces.RealOutput y_im "second component";
  equation
    y_re = u_abs*cos(u_arg);
    y_im = u_abs*sin(u_arg);
  end PolarToRectangular;

  block Max "The greater input"
    extends Interfaces.SI2SO;
  equation
    y = max(u1, u2);
  end Max;

  block Min "The smaller input"
    extends Interfaces.SI2SO;
  equation
    y = min(u1, u2);
  end Min;

  block MinMax "The smallest and the greatest input"
    parameter Integer nu(min = 0) = 0 "number of inputs"
      annotation(Dialog(connectorSizing = true), HideResult = true);
    Interfaces.RealVectorInput u[nu] "inputs";
    Interfaces.RealOutput yMax "greatest";
    Interfaces.RealOutput yMin "smallest";
  equation
    yMax = max(u);
    yMin = min(u);
  end MinMax;

  block LinearDependency "y0 (1 + k1 u1 + k2 u2)"
    extends Interfaces.SI2SO;
    parameter Real y0 = 0 "output where both inputs are zero";
    parameter Real k1 = 0 "weight of the first input";
    parameter Real k2 = 0 "weight of the second input";
  equation
    y = y0*(1 + k1*u1 + k2*u2);
  end LinearDependency;

  block Edge "True where the input becomes true"
    extends Interfaces.BooleanSISO;
  equation
    y = edge(u);
  end Edge;

  block BooleanChange "True where the input changes"
    extends Interfaces.BooleanSISO;
  equation
    y = change(u);
  end BooleanChange;

  block IntegerChange "True where the input changes"
    extends Interfaces.IntegerSIBooleanSO;
  equation
    y = change(u);
  end IntegerChange;
end Math;
