package classes "names that mean nothing, in classes of every kind"
  partial model Incomplete
    Unknown.Type a;
    Real x(start = missingStart);
  equation
    x = missingValue;
  end Incomplete;

  partial function Interface
    input Real u = missingDefault;
    output Real y;
  end Interface;

  function NeverCalled
    input Real u;
    output Real y;
  algorithm
    y := missingFactor*u;
  end NeverCalled;

  function Foreign
    input Real u;
    output Real y;
  external "C" y = foreign(u, missingArgument);
  end Foreign;

  connector Pin
    Real v;
    flow MissingCurrent i;
  end Pin;

  record Values
    Real a = missingConstant;
    Real b[missingSize];
  end Values;

  type Length = MissingReal(unit = "m");

  model Derived
    extends MissingBase;
    Real x = perhapsInherited;
  end Derived;

  model DerivedOnce
    extends Absent.Part;
    extends Absent.Other;
    extends Derived(anything = 1);
  end DerivedOnce;

  partial package Constants
    import Missing.Package.*;
    constant Real c = missingOther;
    replaceable partial function f
      input Real u;
      output Real y;
    algorithm
      y := missingDeep;
    end f;
    function derivative = der(missingFunction, u);
  end Constants;

  function annotated
    input Real x;
    input Real y;
    output Real z = x*y;
    annotation (
      derivative(noDerivative = missingInput) = missingDerivative,
      derivative(order = 2) = classes.missingSecond,
      inverse(x = missingInverse(y, z), w = divided(z, missingDivisor), y = divided(z)),
      smoothOrder(normallyConstant = missingNormally) = 2);
  end annotated;

  function divided
    input Real a;
    input Real b;
    output Real c = a/b;
    annotation (derivative = annotated, inverse(a = annotated(b, c)));
  end divided;

  function byMissing = der(divided, a, missingVariable);

  partial model Removing
    extends Incomplete(break missingPart);
  end Removing;

  operator record Pair
    Real a, b;
    encapsulated operator '+'
      function add
        import classes.Pair;
        input Pair x;
        input Pair y;
        output Pair z = Pair(x.a + y.c, missingSum);
      end add;
    end '+';
  end Pair;
end classes;
