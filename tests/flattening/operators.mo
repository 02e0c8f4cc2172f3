// MLS ch. 14: operator records, their constructors and the conversions of operands.
package operators
  operator record Pair
    Real a;
    Real b;
    encapsulated operator 'constructor'
      function fromReal
        import operators.Pair;
        input Real a;
        input Real b = 0;
        output Pair p(a = a, b = b);
      algorithm
      end fromReal;
    end 'constructor';
    encapsulated operator function '+'
      import operators.Pair;
      input Pair x;
      input Pair y;
      output Pair z;
    algorithm
      z := Pair(x.a + y.a, x.b + y.b);
    end '+';
    encapsulated operator '-'
      function negate
        import operators.Pair;
        input Pair x;
        output Pair y;
      algorithm
        y := Pair(-x.a, -x.b);
      end negate;
      function subtract
        import operators.Pair;
        input Pair x;
        input Pair y;
        output Pair z;
      algorithm
        z := x + (-y);
      end subtract;
    end '-';
  end Pair;
  model Main
    Pair p(a = 1, b = time);
    Pair q = p + 2;
    Pair r;
  equation
    r = -(q - p);
  end Main;
end operators;
