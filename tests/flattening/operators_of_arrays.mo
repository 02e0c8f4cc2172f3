// MLS §14.3 and §14.4: operators on arrays of operator records are those of the elements, whose
// operands may be converted, unless a function of the operator takes the arrays; §14.5: unary ones.
package operators_of_arrays
  operator record C
    Real re, im;
    encapsulated operator 'constructor'
      import operators_of_arrays.C;
      function fromReal
        input Real re;
        input Real im = 0;
        output C result(re = re, im = im);
      algorithm
      end fromReal;
    end 'constructor';
    encapsulated operator function '+'
      import operators_of_arrays.C;
      input C a, b;
      output C c = C(a.re + b.re, a.im + b.im);
    algorithm
    end '+';
    encapsulated operator function '-'
      import operators_of_arrays.C;
      input C a;
      output C c = C(-a.re, -a.im);
    algorithm
    end '-';
    encapsulated operator '*'
      import operators_of_arrays.C;
      function multiply
        input C a, b;
        output C c = C(a.re*b.re - a.im*b.im, a.re*b.im + a.im*b.re);
      algorithm
      end multiply;
      function scalarProduct
        input C a[:], b[size(a, 1)];
        output C c = C(0, 0);
      algorithm
        for i in 1:size(a, 1) loop
          c := c + a[i]*b[i];
        end for;
      end scalarProduct;
    end '*';
  end C;
  model Main
    C a[2] = {C(1, 2), C(3, 4)};
    C sum[2] = a + a;
    C converted[2] = a + {5, 6};
    C negative[2] = -a;
    C product = a*a;
    C scaled[2] = C(0, 1)*a;
    C elementwise[2] = a.*a;
    C shifted[2] = a.+C(1, 1);
  end Main;
end operators_of_arrays;
