// Sizes that an Integer decides which the function computes (MLS 3.6 sec. 10.3.4, 11.2). The branch to the end
// depends on the time, so that the function is not evaluated symbolically.
package Computed
  function early input Real x; output Real y = 0; protected Integer k = 3;
  algorithm
    y := sum(1 for j in 1:k);
    k := k + 1;
    if x > 1.5 then return; end if;
    y := y + 0;
  end early;
  function inLoop input Real x; output Real y = 0; protected Integer k = 3;
  algorithm
    for i in 1:2 loop
      y := y + sum(1 for j in 1:k);
      k := k + 1;
      if x > 1.5 then break; end if;
    end for;
  end inLoop;
  function made input Real x; output Real y = 0; protected Integer k = 3;
  algorithm
    k := k + 1;
    y := sum(ones(k)) + sum(1:k) + max(i*x for i in 1:k);
    if x > 100 then return; end if;
  end made;
  function ofArray input Real x; input Real p[:]; output Real y = 0; protected Integer k = 2;
  algorithm
    k := k + 1;
    y := sum(p[1:k]) + product(p[i] for i in 1:k) + sum(i*j for i in 1:j, j in 1:k);
    if x > 100 then return; end if;
  end ofArray;
  function beyond input Real x; output Real y = 0; protected Integer k = 5; Real v[3] = {1, 2, 3};
  algorithm
    k := k + 5;
    y := sum(v[mod(i, 3) + 1]*x for i in 1:k) + min(i for i in k:-1:2);
    if x > 100 then return; end if;
  end beyond;
  model Early Real y = early(time); end Early;
  model InLoop Real y = inLoop(time); end InLoop;
  model Made Real y = made(time); end Made;
  model OfArray Real y = ofArray(time, {1, 2, 3, 4}); end OfArray;
  model Beyond Real y = beyond(time); end Beyond;
  model Statement
    Integer n(start = 3, fixed = true);
    Real y;
    Real z;
    Real p[2] = {time, 2};
  algorithm
    when time > 0.5 then
      n := pre(n) + 4;
    end when;
  algorithm
    y := sum(i*p[2] for i in 1:n);
    z := sum(ones(n));
  end Statement;
  model Dependent Real y = sum(i*j for i in 1:j, j in 1:3); end Dependent;
end Computed;
