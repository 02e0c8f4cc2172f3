// Arrays of records are assigned in algorithms (MLS 3.6 sec. 10.6.1, 11.2.1), and iterators run over them (sec. 11.2.2).
package Assigned
  record R Real v; Real w[2]; end R;
  record N R r[2]; Real z; end N;
  function make
    input Real x;
    input Integer n;
    output R o[n];
  algorithm
    for i in 1:n loop
      o[i] := R(i*x, {i, x});
    end for;
  end make;
  function two input Real x; output R o[2] = make(x, 2); output Real y = x; end two;
  model Whole R b[2]; algorithm b := make(time, 2); b := {b[2], b[1]}; end Whole;
  model Slices
    R b[3];
    R c[2];
  algorithm
    b := make(time, 3);
    b.v := {7, 8, 9};
    b[2:3].w[1] := {10, 20};
    b[1:2].v := b[2:3].v;
    b[end].v := 100;
    c := b[2:3];
  end Slices;
  model Elements R b[3]; algorithm b[1] := R(time, {2, 3}); b[2] := b[1]; for i in 3:3 loop b[i].v := i; b[i].w := b[1].w; end for; end Elements;
  model Nested N n[2]; algorithm n[1].r := make(time, 2); n[1].z := 1; n[2] := n[1]; n[2].r[1].w := {5, 6}; end Nested;
  model Matrix R b[2, 2]; algorithm for i in 1:2 loop b[i, :] := make(i*time, 2); end for; b[:, 1].v := {50, 60}; end Matrix;
  model Branches R b[2]; algorithm b := make(time, 2); if time > 0.5 then b := make(3*time, 2); end if; end Branches;
  model Outputs R b[2]; Real y; algorithm (b, y) := two(time); end Outputs;
  model Events R b[2](each v(start = 0, fixed = true), each w(each start = 0, each fixed = true)); algorithm when time > 0.5 then b := make(2*time, 2); end when; end Events;
  model Parts
    model Part parameter Integer n = 2; R b[n]; Real s; algorithm b := make(time, n); s := sum(x.v for x in b); end Part;
    Part p[2](n = {2, 3});
  end Parts;
  model Iterators
    R b[2] = make(2*time, 2);
    Real s = sum(x.v*y.v for x in b, y in b);
    Real t[2] = {x.v + x.w[1] for x in b};
    Real u;
    Real q[2];
  equation
    for x in b loop
      assert(x.v >= 0, "negative");
    end for;
    q = {max(x.w) for x in b};
  algorithm
    u := 0;
    for x in b loop
      u := u + x.v*x.w[2];
    end for;
  end Iterators;
  model WrongSize R b[3]; algorithm b := make(time, 2); end WrongSize;
end Assigned;
