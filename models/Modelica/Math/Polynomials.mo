within Modelica.Math;
package Polynomials "Functions of polynomials: vectors of coefficients, the highest power first"
  extends Modelica.Icons.Package;

  function evaluate "Value of a polynomial"
    extends Modelica.Icons.Function;
    input Real p[:] "coefficients";
    input Real u "argument";
    output Real y "value";
  algorithm
    y := 0;
    for i in 1:size(p, 1) loop
      y := y*u + p[i];
    end for;
  end evaluate;

  function evaluateWithRange "Value of a polynomial, of its tangents outside of a range"
    extends Modelica.Icons.Function;
    input Real p[:] "coefficients";
    input Real uMin "lower end of the range";
    input Real uMax "upper end of the range";
    input Real u "argument";
    output Real y "value";
  protected
    Real inside = min(max(u, uMin), uMax) "nearest argument in the range";
  algorithm
    y := evaluate(p, inside) + (u - inside)*derivativeValue(p, inside);
  end evaluateWithRange;

  function derivative "Derivative of a polynomial"
    extends Modelica.Icons.Function;
    input Real p1[:] "coefficients";
    output Real p2[size(p1, 1) - 1] "coefficients of the derivative";
  protected
    Integer n = size(p1, 1) "number of coefficients";
  algorithm
    p2 := {p1[i]*(n - i) for i in 1:n - 1};
  end derivative;

  function derivativeValue "Value of the derivative of a polynomial"
    extends Modelica.Icons.Function;
    input Real p[:] "coefficients";
    input Real u "argument";
    output Real y "value";
  protected
    Integer n = size(p, 1) "number of coefficients";
  algorithm
    y := 0;
    for i in 1:n - 1 loop
      y := y*u + p[i]*(n - i);
    end for;
  end derivativeValue;

  function secondDerivativeValue "Value of the second derivative of a polynomial"
    extends Modelica.Icons.Function;
    input Real p[:] "coefficients";
    input Real u "argument";
    output Real y "value";
  protected
    Integer n = size(p, 1) "number of coefficients";
  algorithm
    y := 0;
    for i in 1:n - 2 loop
      y := y*u + p[i]*(n - i)*(n - i - 1);
    end for;
  end secondDerivativeValue;

  function integral "Antiderivative of a polynomial that is zero at zero"
    extends Modelica.Icons.Function;
    input Real p1[:] "coefficients";
    output Real p2[size(p1, 1) + 1] "coefficients of the antiderivative";
  protected
    Integer n = size(p1, 1) + 1 "number of coefficients";
  algorithm
    for i in 1:n - 1 loop
      p2[i] := p1[i]/(n - i);
    end for;
    p2[n] := 0;
  end integral;

  function integralValue "Integral of a polynomial between two arguments"
    extends Modelica.Icons.Function;
    input Real p[:] "coefficients";
    input Real u_high "upper limit";
    input Real u_low = 0 "lower limit";
    output Real integral "value";
  protected
    Integer n = size(p, 1) "number of coefficients";
    Real low "antiderivative at the lower limit";
  algorithm
    integral := 0;
    low := 0;
    for i in 1:n loop
      integral := (integral + p[i]/(n + 1 - i))*u_high;
      low := (low + p[i]/(n + 1 - i))*u_low;
    end for;
    integral := integral - low;
  end integralValue;

  function fitting "The polynomial nearest to points in the sense of least squares"
    extends Modelica.Icons.Function;
    input Real u[:] "arguments";
    input Real y[size(u, 1)] "values";
    input Integer n(min = 1) "degree";
    output Real p[n + 1] "coefficients";
  protected
    Real powers[size(u, 1), n + 1] "powers of the arguments";
  algorithm
    for i in 1:size(u, 1) loop
      powers[i, n + 1] := 1;
      for j in n:-1:1 loop
        powers[i, j] := powers[i, j + 1]*u[i];
      end for;
    end for;
    p := Modelica.Math.Matrices.leastSquares(powers, y);
  end fitting;

  function roots "Zeros of a polynomial whose first coefficient is not zero"
    extends Modelica.Icons.Function;
    input Real p[:] "coefficients";
    output Real roots[max(0, size(p, 1) - 1), 2] "real and imaginary parts, a row each";
  protected
    Integer n = size(p, 1) - 1 "degree";
    Real companion[max(0, size(p, 1) - 1), max(0, size(p, 1) - 1)] "the matrix with these eigenvalues";
  algorithm
    if n > 0 then
      assert(abs(p[1]) > 0, "the first coefficient of the polynomial is zero");
      companion := zeros(n, n);
      for i in 1:n loop
        companion[1, i] := -p[i + 1]/p[1];
      end for;
      for i in 2:n loop
        companion[i, i - 1] := 1;
      end for;
      roots := Modelica.Math.Matrices.eigenValues(companion);
    end if;
  end roots;
end Polynomials;
