// MLS §10.3.4, §14.4: sums, comprehensions and products with matrices of operator records
package SumsOfRecords
  operator record V
    Real x;
    Real y;
    encapsulated operator 'constructor'
      function fromReal
        import SumsOfRecords.V;
        input Real x;
        input Real y = 0;
        output V r(x = x, y = y);
      algorithm
      end fromReal;
    end 'constructor';
    encapsulated operator '0'
      function zero
        import SumsOfRecords.V;
        output V r;
      algorithm
        r := V(0, 0);
      end zero;
    end '0';
    encapsulated operator function '+'
      import SumsOfRecords.V;
      input V a;
      input V b;
      output V r;
    algorithm
      r := V(a.x + b.x, a.y + b.y);
    end '+';
    encapsulated operator function '*'
      import SumsOfRecords.V;
      input V a;
      input V b;
      output V r;
    algorithm
      r := V(a.x*b.x - a.y*b.y, a.x*b.y + a.y*b.x);
    end '*';
  end V;
  model Sums
    V a[3] = {V(i, 2*i) for i in 1:3};
    V s = sum(a);
    V t = sum(V(i, time) for i in 1:3);
    V u = sum({V(1, 2), V(3, time)});
    V m[2, 2] = {{V(1), V(2)}, {V(3), V(4, time)}};
    V p[2] = m*{V(1), V(0, 1)};
    V q[2, 2] = m*m;
  end Sums;
end SumsOfRecords;
