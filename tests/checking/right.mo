package right "what is declared, or may be where the class is used"
  import Alias = right.Numbers;
  import right.Numbers.{one, half};

  package Numbers
    constant Real one = 1;
    constant Real two = 2;
    function half
      input Real u;
      output Real y = u/2;
    end half;
  end Numbers;

  partial package Medium
    constant Integer n = 1;
    replaceable partial model Properties
      Real p;
    end Properties;
    replaceable partial function density
      input Real p;
      output Real d;
    end density;
  end Medium;

  package Water
    extends Medium;
    constant Real extra = 3;
    redeclare replaceable model extends Properties(p = 1)
      parameter Real anything = 0;
      Real other = 2;
      Real d = density(p) + extra + n;
    end Properties;
    redeclare function extends density
      input Real factor = 1;
    algorithm
      d := factor*p;
    end density;
  end Water;

  package Ice
    extends Water;
    redeclare model extends Properties(other = 3)
      Real more = p + d + anything;
    end Properties;
  end Ice;

  function frozen
    input Real u;
    output Real y = u*half(u);
    annotation (derivative(order = 1) = frozen_der, inverse(u = half(u = y)), smoothOrder = 2);
  end frozen;

  function frozen_der
    input Real u;
    input Real der_u;
    output Real der_y = 2*u*der_u;
  end frozen_der;

  connector Signal = output Real;

  expandable connector Bus
  end Bus;

  partial model Uses
    replaceable package M = Medium;
    M.Properties properties(anything = 1);
    Bus bus;
    Signal signal;
    Real x[3] = {i*Alias.two for i in 1:3};
    Real y = M.density(1, factor = 2) + M.extra + properties.other;
    Real z = sum(k for k in 1:3) + half(one) + .sin(time);
    replaceable Real r(unit = "V") = 1;
  equation
    signal = 1;
    connect(signal, bus.signal);
    connect(signal, bus.other);
    for i in 1:3 loop
      assert(x[i] > 0, String(i), AssertionLevel.warning);
    end for;
  end Uses;

  model Inherits
    extends Uses(redeclare package M = Water);
    Real w = M.extra + y + x[end];
    parameter StateSelect select = StateSelect.prefer;
    Real v(stateSelect = select, start = 0) = der(w);
  end Inherits;

  function nested
    input Real u;
    output Real y;
  protected
    function part
      input Real u;
      output Real y = u*Numbers.two;
    end part;
  algorithm
    for i in 1:integer(u) loop
      y := part(u) + i;
    end for;
    (y, ) := two(u);
    y := Modelica.Math.sin(u);
  end nested;

  function two
    input Real u;
    output Real a = u;
    output Real b = u;
  end two;
end right;
