// MLS §14.4: arrays of different sizes have no sum, and where no function of the operator takes
// the arrays, there is no product of them.
package operators_of_arrays_wrong
  operator record C
    Real x;
    encapsulated operator function '+'
      import operators_of_arrays_wrong.C;
      input C a, b;
      output C c = C(a.x + b.x);
    algorithm
    end '+';
    encapsulated operator function '*'
      import operators_of_arrays_wrong.C;
      input C a, b;
      output C c = C(a.x*b.x);
    algorithm
    end '*';
  end C;
  model Main
    C a[2] = {C(1), C(2)};
    C sum[2] = a + {C(1), C(2), C(3)};
    C product = a*a;
  end Main;
end operators_of_arrays_wrong;
