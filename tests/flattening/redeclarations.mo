// MLS §7.3.1, §7.3.2, §7.3.3: class extends, constraining clauses with modifications, `choices`;
// §12.4.1 defaults of functions, §12.4.6 one call for each element.
package redeclarations
  partial model Interface
    Real y;
  end Interface;
  model Constant
    extends Interface;
    parameter Real k = 1;
  equation
    y = k;
  end Constant;
  model Ramp
    extends Interface;
    parameter Real k = 2;
    parameter Real offset = 0;
  equation
    y = k*time + offset;
  end Ramp;
  function f
    input Real x;
    input Real a = 10;
    output Real y = a*x;
  algorithm
  end f;
  model Frame
    replaceable model Source = Constant constrainedby Interface;
    replaceable Constant c constrainedby Constant(k = 5);
    Source s;
    replaceable model Extended
      Real e = 1;
    end Extended;
    Extended extended;
  end Frame;
  model Derived
    extends Frame;
    redeclare model extends Extended
      Real more = e + 1;
    end Extended;
  end Derived;
  model Main
    Frame plain;
    Derived derived(redeclare model Source = Ramp(offset = 3));
    Real z[2] = f({1, time}, a = 2);
    Real d = f(4);
  end Main;
end redeclarations;
