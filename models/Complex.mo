within;
operator record Complex "Complex number"
  replaceable Real re "real part";
  replaceable Real im "imaginary part";

  encapsulated operator 'constructor' "Complex numbers from real ones"
    function fromReal "The number re + j im"
      import Complex;
      input Real re "real part";
      input Real im = 0 "imaginary part";
      output Complex result(re = re, im = im) "the number";
    algorithm
      annotation(Inline = true);
    end fromReal;
  end 'constructor';

  encapsulated operator function '0' "The neutral element of addition"
    import Complex;
    output Complex result "zero";
  algorithm
    result := Complex(0);
    annotation(Inline = true);
  end '0';

  encapsulated operator '-' "Negation and difference"
    function negate "-c1"
      import Complex;
      input Complex c1 "a number";
      output Complex c2 "its negative";
    algorithm
      c2 := Complex(-c1.re, -c1.im);
      annotation(Inline = true);
    end negate;

    function subtract "c1 - c2"
      import Complex;
      input Complex c1 "minuend";
      input Complex c2 "subtrahend";
      output Complex c3 "difference";
    algorithm
      c3 := Complex(c1.re - c2.re, c1.im - c2.im);
      annotation(Inline = true);
    end subtract;
  end '-';

  encapsulated operator '*' "Products"
    function multiply "c1*c2"
      import Complex;
      input Complex c1 "factor";
      input Complex c2 "factor";
      output Complex c3 "product";
    algorithm
      c3 := Complex(c1.re*c2.re - c1.im*c2.im, c1.re*c2.im + c1.im*c2.re);
      annotation(Inline = true);
    end multiply;

    function scalarProduct "Sum of the products of the elements"
      import Complex;
      input Complex c1[:] "vector";
      input Complex c2[size(c1, 1)] "vector of the same size";
      output Complex c3 "sum of c1[i]*c2[i]";
    algorithm
      c3 := Complex(0);
      for i in 1:size(c1, 1) loop
        c3 := c3 + c1[i]*c2[i];
      end for;
    end scalarProduct;
  end '*';

  encapsulated operator function '+' "Sum"
    import Complex;
    input Complex c1 "summand";
    input Complex c2 "summand";
    output Complex c3 "sum";
  algorithm
    c3 := Complex(c1.re + c2.re, c1.im + c2.im);
    annotation(Inline = true);
  end '+';

  encapsulated operator function '/' "Quotient"
    import Complex;
    input Complex c1 "dividend";
    input Complex c2 "divisor";
    output Complex c3 "quotient";
  protected
    Real square = c2.re*c2.re + c2.im*c2.im "squared absolute value of the divisor";
  algorithm
    c3 := Complex((c1.re*c2.re + c1.im*c2.im)/square, (c1.im*c2.re - c1.re*c2.im)/square);
    annotation(Inline = true);
  end '/';

  encapsulated operator '^' "Powers"
    function complexPower "Principal value of c1 to the power of c2"
      import Complex;
      input Complex c1 "base";
      input Complex c2 "exponent";
      output Complex c3 "power";
    protected
      Real modulus = sqrt(c1.re*c1.re + c1.im*c1.im) "absolute value of the base";
      Real angle = atan2(c1.im, c1.re) "argument of the base";
      Real grown "absolute value of the power";
      Real turned "argument of the power";
    algorithm
      if modulus > 0 then
        grown := exp(log(modulus)*c2.re - angle*c2.im);
        turned := log(modulus)*c2.im + angle*c2.re;
        c3 := Complex(grown*cos(turned), grown*sin(turned));
      else
        c3 := Complex(if c2.re == 0 and c2.im == 0 then 1 else 0);
      end if;
    end complexPower;

    function integerPower "c1 multiplied with itself, c2 times"
      import Complex;
      input Complex c1 "base";
      input Integer c2 "exponent";
      output Complex c3 "power";
    protected
      Complex square "base to a power of two";
      Integer left "what is left of the exponent";
    algorithm
      c3 := Complex(1);
      square := if c2 < 0 then Complex(1)/c1 else c1;
      left := abs(c2);
      while left > 0 loop
        if mod(left, 2) == 1 then
          c3 := c3*square;
        end if;
        square := square*square;
        left := div(left, 2);
      end while;
    end integerPower;
  end '^';

  encapsulated operator function '==' "Equality of both parts"
    import Complex;
    input Complex c1 "a number";
    input Complex c2 "another";
    output Boolean result "true if they are equal";
  algorithm
    result := c1.re == c2.re and c1.im == c2.im;
    annotation(Inline = true);
  end '==';

  encapsulated operator function '<>' "Difference of a part"
    import Complex;
    input Complex c1 "a number";
    input Complex c2 "another";
    output Boolean result "true if they differ";
  algorithm
    result := c1.re <> c2.re or c1.im <> c2.im;
    annotation(Inline = true);
  end '<>';

  encapsulated operator function 'String' "Text of the number, such as 1 + 2*j"
    import Complex;
    input Complex c "a number";
    input String name = "j" "name of the imaginary unit";
    input Integer significantDigits = 6 "digits of each part";
    output String s = "" "text";
  algorithm
    s := String(c.re, significantDigits = significantDigits);
    if c.im <> 0 then
      s := s + (if c.im < 0 then " - " else " + ")
             + String(abs(c.im), significantDigits = significantDigits) + "*" + name;
    end if;
  end 'String';
  annotation(version = "4.0.0", Documentation(info = "<html>
<p>Numbers <code>re + j im</code> with the operators of arithmetic, by the overloading of operators
of Modelica (chapter 14 of its specification).</p>
</html>"));
end Complex;
