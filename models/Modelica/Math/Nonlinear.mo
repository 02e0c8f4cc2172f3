within Modelica.Math;
package Nonlinear "Zeros and integrals of functions that are given as arguments"
  extends Modelica.Icons.Package;

  package Interfaces "What the functions look like"
    extends Modelica.Icons.InterfacesPackage;

    partial function partialScalarFunction "A function of one number"
      input Real u "argument";
      output Real y "value";
    end partialScalarFunction;
  end Interfaces;

  function quadratureLobatto
    "Integral of a function, by halving nothing but the intervals that need it (Gander and Gautschi, BIT 40, 2000)"
    extends Modelica.Icons.Function;
    input Modelica.Math.Nonlinear.Interfaces.partialScalarFunction f "integrand";
    input Real a "lower limit";
    input Real b "upper limit";
    input Real tolerance = 100*Modelica.Constants.eps "relative to the size of the integral";
    output Real integral "of f over a .. b";
  protected
    Real scale "size of the integral, beside which a difference does not count";
    Real h = (b - a)/2 "half of the length";
    Real m = (a + b)/2 "middle";
    constant Real x[3] = {0.942882415695480, 0.641853342345781, 0.236383199662150}
      "points of the rule that gives the size";
    Real fa = f(a) "value at a";
    Real fb = f(b) "value at b";
  algorithm
    scale := abs(h)*(0.0158271919734802*(abs(fa) + abs(fb))
      + 0.0942738402188500*(abs(f(m - x[1]*h)) + abs(f(m + x[1]*h)))
      + 0.155071987336585*(abs(f(m - sqrt(2/3)*h)) + abs(f(m + sqrt(2/3)*h)))
      + 0.188821573960182*(abs(f(m - x[2]*h)) + abs(f(m + x[2]*h)))
      + 0.199773405226859*(abs(f(m - h/sqrt(5))) + abs(f(m + h/sqrt(5))))
      + 0.224926465333340*(abs(f(m - x[3]*h)) + abs(f(m + x[3]*h)))
      + 0.242611071901408*abs(f(m)));
    scale := max(scale, Modelica.Constants.small)*max(tolerance, Modelica.Constants.eps);
    integral := part(function f(), a, b, fa, fb, scale, 0);
  end quadratureLobatto;

  function part "Integral over one interval, in six parts where two rules differ"
    extends Modelica.Icons.Function;
    input Modelica.Math.Nonlinear.Interfaces.partialScalarFunction f "integrand";
    input Real a "lower limit";
    input Real b "upper limit";
    input Real fa "value at a";
    input Real fb "value at b";
    input Real accepted "difference that is accepted";
    input Integer depth "how often the interval was divided";
    output Real integral "of f over a .. b";
  protected
    Real h = (b - a)/2 "half of the length";
    Real m = (a + b)/2 "middle";
    Real at[7] = {a, m - sqrt(2/3)*h, m - h/sqrt(5), m, m + h/sqrt(5), m + sqrt(2/3)*h, b}
      "points";
    Real y[7] = {fa, f(at[2]), f(at[3]), f(m), f(at[5]), f(at[6]), fb} "values there";
    Real lobatto = h/6*(y[1] + y[7] + 5*(y[3] + y[5])) "rule with 4 points";
    Real kronrod = h/1470*(77*(y[1] + y[7]) + 432*(y[2] + y[6]) + 625*(y[3] + y[5]) + 672*y[4])
      "rule with 7 points";
  algorithm
    integral := kronrod;
    if abs(kronrod - lobatto) > accepted and depth < 12 then
      integral := 0;
      for i in 1:6 loop
        integral := integral
          + part(function f(), at[i], at[i + 1], y[i], y[i + 1], accepted, depth + 1);
      end for;
    end if;
  end part;

  function solveOneNonlinearEquation
    "Zero of a function between two arguments where it has different signs (Brent, 1973, ch. 4)"
    extends Modelica.Icons.Function;
    input Modelica.Math.Nonlinear.Interfaces.partialScalarFunction f "function";
    input Real u_min "lower end";
    input Real u_max "upper end";
    input Real tolerance = 100*Modelica.Constants.eps "of the zero, relative";
    output Real u "where f is zero";
  protected
    Real a = u_min "one end";
    Real b = u_max "the best argument so far";
    Real c = u_min "the other end: f has another sign there than at b";
    Real d "last step";
    Real e "step before";
    Real fa = f(u_min) "value at a";
    Real fb = f(u_max) "value at b";
    Real fc "value at c";
    Real m "half of the way from b to c";
    Real p "numerator of the next step";
    Real q "its denominator";
    Real r "ratio of values";
    Real s "ratio of values";
    Real close "length below which steps do not count";
    Boolean found = false "whether b is close enough";
  algorithm
    assert(fa == 0 or fb == 0 or (fa < 0) <> (fb < 0),
      "The function has the same sign at both ends: f(" + String(u_min) + ") = " + String(fa)
      + ", f(" + String(u_max) + ") = " + String(fb));
    fc := fa;
    d := b - a;
    e := d;
    while not found loop
      if (fb < 0) == (fc < 0) and fb <> 0 then
        c := a;
        fc := fa;
        d := b - a;
        e := d;
      end if;
      if abs(fc) < abs(fb) then
        a := b;
        b := c;
        c := a;
        fa := fb;
        fb := fc;
        fc := fa;
      end if;
      close := 2*Modelica.Constants.eps*abs(b) + max(tolerance*abs(b), Modelica.Constants.small)/2;
      m := (c - b)/2;
      found := abs(m) <= close or fb == 0;
      if not found then
        if abs(e) < close or abs(fa) <= abs(fb) then
          d := m;
          e := m;
        else
          s := fb/fa;
          if a == c then
            p := 2*m*s;
            q := 1 - s;
          else
            q := fa/fc;
            r := fb/fc;
            p := s*(2*m*q*(q - r) - (b - a)*(r - 1));
            q := (q - 1)*(r - 1)*(s - 1);
          end if;
          if p > 0 then
            q := -q;
          else
            p := -p;
          end if;
          if 2*p < min(3*m*q - abs(close*q), abs(e*q)) then
            e := d;
            d := p/q;
          else
            d := m;
            e := m;
          end if;
        end if;
        a := b;
        fa := fb;
        b := b + (if abs(d) > close then d elseif m > 0 then close else -close);
        fb := f(b);
      end if;
    end while;
    u := b;
  end solveOneNonlinearEquation;
end Nonlinear;
