// MLS §7.2: outer modifications override inner ones, element by element; names mean what they
// mean where they are written.
package nested_modifications
  model Inner
    parameter Real a = 1;
    parameter Real b = 2*a;
    Real x(start = a);
  equation
    der(x) = b;
  end Inner;
  model Middle
    parameter Real a = 10;
    Inner inner_(a = a, x(start = 7));
  end Middle;
  model Main
    parameter Real c = 5;
    Middle m(a = c, inner_.b = c + 1);
  end Main;
end nested_modifications;
