within Modelica;
package ComplexMath "Functions of complex numbers"
  extends Modelica.Icons.Package;
  final constant Complex j = Complex(0, 1) "imaginary unit";

  package Vectors "Functions of vectors of complex numbers"
    extends Modelica.Icons.Package;

    function norm "p-norm of a vector"
      extends Modelica.Icons.Function;
      input Complex v[:] "vector";
      input Real p(min = 1) = 2 "1, 2, Modelica.Constants.inf, or a number between";
      output Real result "norm";
    algorithm
      result := Modelica.Math.Vectors.norm({Modelica.ComplexMath.abs(v[i]) for i in 1:size(v, 1)}, p);
    end norm;

    function length "Euclidean length of a vector"
      extends Modelica.Icons.Function;
      input Complex v[:] "vector";
      output Real result "length";
    algorithm
      result := norm(v, 2);
    end length;

    function reverse "The elements from last to first"
      extends Modelica.Icons.Function;
      input Complex v[:] "vector";
      output Complex result[size(v, 1)] "reversed vector";
    algorithm
      result := {v[size(v, 1) + 1 - i] for i in 1:size(v, 1)};
    end reverse;
  end Vectors;

  function abs "Absolute value"
    extends Modelica.Icons.Function;
    input Complex c "number";
    output Real result "absolute value";
  algorithm
    result := (c.re^2 + c.im^2)^0.5;
    annotation(Inline = true);
  end abs;

  function arg "Argument"
    extends Modelica.Icons.Function;
    input Complex c "number";
    input Modelica.Units.SI.Angle phi0 = 0 "of all turns the argument nearest to this angle";
    output Modelica.Units.SI.Angle phi "argument";
  algorithm
    phi := Modelica.Math.atan3(c.im, c.re, phi0);
    annotation(Inline = true);
  end arg;

  function conj "Conjugate number"
    extends Modelica.Icons.Function;
    input Complex c1 "number";
    output Complex c2 "conjugate number";
  algorithm
    c2 := Complex(c1.re, -c1.im);
    annotation(Inline = true);
  end conj;

  function real "Real part"
    extends Modelica.Icons.Function;
    input Complex c "number";
    output Real r "real part";
  algorithm
    r := c.re;
    annotation(Inline = true);
  end real;

  function imag "Imaginary part"
    extends Modelica.Icons.Function;
    input Complex c "number";
    output Real r "imaginary part";
  algorithm
    r := c.im;
    annotation(Inline = true);
  end imag;

  function fromPolar "The number of an absolute value and an argument"
    extends Modelica.Icons.Function;
    input Real len "absolute value";
    input Modelica.Units.SI.Angle phi "argument";
    output Complex c "number";
  algorithm
    c := Complex(len*Modelica.Math.cos(phi), len*Modelica.Math.sin(phi));
    annotation(Inline = true);
  end fromPolar;

  function exp "Exponential function"
    extends Modelica.Icons.Function;
    input Complex c1 "number";
    output Complex c2 "value";
  algorithm
    c2 := fromPolar(Modelica.Math.exp(c1.re), c1.im);
    annotation(Inline = true);
  end exp;

  function log "Natural logarithm, principal value"
    extends Modelica.Icons.Function;
    input Complex c1 "number, not zero";
    output Complex c2 "value";
  algorithm
    c2 := Complex(Modelica.Math.log(Modelica.ComplexMath.abs(c1)), arg(c1));
    annotation(Inline = true);
  end log;

  function sqrt "Square root, principal value"
    extends Modelica.Icons.Function;
    input Complex c1 "number";
    output Complex c2 "root with a real part of at least 0";
  algorithm
    c2 := fromPolar(Modelica.ComplexMath.abs(c1)^0.5, arg(c1)/2);
    annotation(Inline = true);
  end sqrt;

  function sin "Sine"
    extends Modelica.Icons.Function;
    input Complex c1 "number";
    output Complex c2 "value";
  algorithm
    c2 := Complex(Modelica.Math.sin(c1.re)*Modelica.Math.cosh(c1.im),
      Modelica.Math.cos(c1.re)*Modelica.Math.sinh(c1.im));
    annotation(Inline = true);
  end sin;

  function cos "Cosine"
    extends Modelica.Icons.Function;
    input Complex c1 "number";
    output Complex c2 "value";
  algorithm
    c2 := Complex(Modelica.Math.cos(c1.re)*Modelica.Math.cosh(c1.im),
      -Modelica.Math.sin(c1.re)*Modelica.Math.sinh(c1.im));
    annotation(Inline = true);
  end cos;

  function tan "Tangent"
    extends Modelica.Icons.Function;
    input Complex c1 "number";
    output Complex c2 "value";
  algorithm
    c2 := Modelica.ComplexMath.sin(c1)/Modelica.ComplexMath.cos(c1);
    annotation(Inline = true);
  end tan;

  function sinh "Hyperbolic sine"
    extends Modelica.Icons.Function;
    input Complex c1 "number";
    output Complex c2 "value";
  algorithm
    c2 := Complex(Modelica.Math.sinh(c1.re)*Modelica.Math.cos(c1.im),
      Modelica.Math.cosh(c1.re)*Modelica.Math.sin(c1.im));
    annotation(Inline = true);
  end sinh;

  function cosh "Hyperbolic cosine"
    extends Modelica.Icons.Function;
    input Complex c1 "number";
    output Complex c2 "value";
  algorithm
    c2 := Complex(Modelica.Math.cosh(c1.re)*Modelica.Math.cos(c1.im),
      Modelica.Math.sinh(c1.re)*Modelica.Math.sin(c1.im));
    annotation(Inline = true);
  end cosh;

  function tanh "Hyperbolic tangent"
    extends Modelica.Icons.Function;
    input Complex c1 "number";
    output Complex c2 "value";
  algorithm
    c2 := Modelica.ComplexMath.sinh(c1)/Modelica.ComplexMath.cosh(c1);
    annotation(Inline = true);
  end tanh;

  function sum "Sum of a vector"
    extends Modelica.Icons.Function;
    input Complex v[:] "vector";
    output Complex result "sum";
  algorithm
    result := Complex(0);
    for i in 1:size(v, 1) loop
      result := result + v[i];
    end for;
  end sum;

  function product "Product of a vector"
    extends Modelica.Icons.Function;
    input Complex v[:] "vector";
    output Complex result "product";
  algorithm
    result := Complex(1);
    for i in 1:size(v, 1) loop
      result := result*v[i];
    end for;
  end product;
end ComplexMath;
