// MLS §8.3.1, §12.3: both sides have one type, and equations call no impure functions.
package types_of_equations
  impure function f
    input Real u;
    output Real y = u;
  end f;
  model Main
    type E = enumeration(a, b);
    Real x;
    Boolean flag;
    E e;
    E good;
    Integer n;
    Real y = f(1);
  equation
    x = flag;
    flag = 1;
    e = n;
    good = E.b;
    n = x;
  end Main;
end types_of_equations;
