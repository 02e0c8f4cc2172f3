within Modelica;
package Math "Functions of mathematics"
  extends Modelica.Icons.Package;

  package Icons "Base classes without content"
    extends Modelica.Icons.IconsPackage;
    partial function AxisLeft "Base of functions" end AxisLeft;
    partial function AxisCenter "Base of functions" end AxisCenter;
  end Icons;

  function sin "Sine"
    extends Modelica.Math.Icons.AxisLeft;
    input Modelica.Units.SI.Angle u "angle";
    output Real y "value";
  external "builtin" y = sin(u);
  end sin;

  function cos "Cosine"
    extends Modelica.Math.Icons.AxisLeft;
    input Modelica.Units.SI.Angle u "angle";
    output Real y "value";
  external "builtin" y = cos(u);
  end cos;

  function tan "Tangent; not at odd multiples of pi/2"
    extends Modelica.Math.Icons.AxisLeft;
    input Modelica.Units.SI.Angle u "angle";
    output Real y "value";
  external "builtin" y = tan(u);
  end tan;

  function asin "Angle of a sine"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u "between -1 and 1";
    output Modelica.Units.SI.Angle y "between -pi/2 and pi/2";
  external "builtin" y = asin(u);
  end asin;

  function acos "Angle of a cosine"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u "between -1 and 1";
    output Modelica.Units.SI.Angle y "between 0 and pi";
  external "builtin" y = acos(u);
  end acos;

  function atan "Angle of a tangent"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u "number";
    output Modelica.Units.SI.Angle y "between -pi/2 and pi/2";
  external "builtin" y = atan(u);
  end atan;

  function atan2 "Angle of the point (u2, u1)"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u1 "ordinate";
    input Real u2 "abscissa";
    output Modelica.Units.SI.Angle y "above -pi, at most pi";
  external "builtin" y = atan2(u1, u2);
  end atan2;

  function sinh "Hyperbolic sine"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u "number";
    output Real y "value";
  external "builtin" y = sinh(u);
  end sinh;

  function cosh "Hyperbolic cosine"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u "number";
    output Real y "value";
  external "builtin" y = cosh(u);
  end cosh;

  function tanh "Hyperbolic tangent"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u "number";
    output Real y "value";
  external "builtin" y = tanh(u);
  end tanh;

  function exp "Exponential function"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u "number";
    output Real y "value";
  external "builtin" y = exp(u);
  end exp;

  function log "Natural logarithm"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u "positive number";
    output Real y "value";
  external "builtin" y = log(u);
  end log;

  function log10 "Logarithm to the base of 10"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u "positive number";
    output Real y "value";
  external "builtin" y = log10(u);
  end log10;

  function asinh "Inverse of the hyperbolic sine"
    extends Modelica.Math.Icons.AxisCenter;
    input Real u "number";
    output Real y "value";
  algorithm
    y := if u < 0 then -Modelica.Math.log(-u + sqrt(u*u + 1)) else Modelica.Math.log(u + sqrt(u*u + 1));
    annotation(Inline = true);
  end asinh;

  function acosh "Inverse of the hyperbolic cosine"
    extends Modelica.Math.Icons.AxisLeft;
    input Real u(min = 1.0) "number, at least 1";
    output Real y "value, at least 0";
  algorithm
    assert(u >= 1, "the argument of acosh is less than 1");
    y := Modelica.Math.log(u + sqrt(u*u - 1));
  end acosh;

  function atan3 "Angle of the point (u2, u1), of all turns the one nearest to another angle"
    extends Modelica.Math.Icons.AxisCenter;
    input Real u1 "ordinate";
    input Real u2 "abscissa";
    input Modelica.Units.SI.Angle y0 = 0 "the other angle";
    output Modelica.Units.SI.Angle y "angle within pi of the other";
  protected
    Modelica.Units.SI.Angle first = Modelica.Math.atan2(u1, u2) "angle of the first turn";
    constant Modelica.Units.SI.Angle turn = 2*Modelica.Constants.pi "one turn";
  algorithm
    y := first + turn*floor((y0 - first)/turn + 0.5);
  end atan3;

  function isEqual "Whether two numbers are equal within a tolerance"
    extends Modelica.Icons.Function;
    input Real s1 "number";
    input Real s2 "another";
    input Real eps(min = 0) = 0 "tolerance";
    output Boolean result "whether they are";
  algorithm
    result := abs(s1 - s2) <= eps;
    annotation(Inline = true);
  end isEqual;

  function isPowerOf2 "Whether an integer is a power of two"
    extends Modelica.Icons.Function;
    input Integer i(min = 1) "integer, at least 1";
    output Boolean result "whether it is";
  protected
    Integer left = i "the integer without factors of two";
  algorithm
    assert(i >= 1, "the argument of isPowerOf2 is less than 1");
    while mod(left, 2) == 0 loop
      left := div(left, 2);
    end while;
    result := left == 1;
  end isPowerOf2;

  function wrapAngle "The same angle in a range of one turn"
    extends Modelica.Math.Icons.AxisLeft;
    input Modelica.Units.SI.Angle u "angle";
    input Boolean positiveRange = false "0 <= y < 2 pi, else -pi < y <= pi";
    output Modelica.Units.SI.Angle y "the same angle";
  protected
    constant Modelica.Units.SI.Angle turn = 2*Modelica.Constants.pi "one turn";
  algorithm
    y := u - turn*(if positiveRange then floor(u/turn) else ceil(u/turn - 0.5));
  end wrapAngle;

  package BooleanVectors "Functions of vectors of truth values"
    extends Modelica.Icons.Package;

    function allTrue "Whether all elements are true; false without elements"
      extends Modelica.Icons.Function;
      input Boolean b[:] "vector";
      output Boolean result "whether they are";
    algorithm
      result := size(b, 1) > 0 and countTrue(b) == size(b, 1);
    end allTrue;

    function andTrue "Whether all elements are true; true without elements"
      extends Modelica.Icons.Function;
      input Boolean b[:] "vector";
      output Boolean result "whether they are";
    algorithm
      result := countTrue(b) == size(b, 1);
    end andTrue;

    function anyTrue "Whether an element is true"
      extends Modelica.Icons.Function;
      input Boolean b[:] "vector";
      output Boolean result "whether one is";
    algorithm
      result := countTrue(b) > 0;
    end anyTrue;

    function oneTrue "Whether exactly one element is true"
      extends Modelica.Icons.Function;
      input Boolean b[:] "vector";
      output Boolean result "whether one is";
    algorithm
      result := countTrue(b) == 1;
    end oneTrue;

    function countTrue "Number of elements that are true"
      extends Modelica.Icons.Function;
      input Boolean b[:] "vector";
      output Integer n "number";
    algorithm
      n := 0;
      for i in 1:size(b, 1) loop
        n := n + (if b[i] then 1 else 0);
      end for;
    end countTrue;

    function firstTrueIndex "Index of the first element that is true"
      extends Modelica.Icons.Function;
      input Boolean b[:] "vector";
      output Integer index "index; 0 if there is none";
    algorithm
      index := 0;
      for i in size(b, 1):-1:1 loop
        index := if b[i] then i else index;
      end for;
    end firstTrueIndex;

    function index "Indices of the elements that are true"
      extends Modelica.Icons.Function;
      input Boolean b[:] "vector";
      output Integer indices[countTrue(b)] "indices, rising";
    protected
      Integer n = 0 "number of elements found";
    algorithm
      for i in 1:size(b, 1) loop
        if b[i] then
          n := n + 1;
          indices[n] := i;
        end if;
      end for;
    end index;

    function enumerate "Numbers of the elements that are true, counted from 1; 0 for the others"
      extends Modelica.Icons.Function;
      input Boolean b[:] "vector";
      output Integer enumerated[size(b, 1)] "numbers";
    protected
      Integer n = 0 "number of elements found";
    algorithm
      for i in 1:size(b, 1) loop
        n := n + (if b[i] then 1 else 0);
        enumerated[i] := if b[i] then n else 0;
      end for;
    end enumerate;
  end BooleanVectors;
end Math;
