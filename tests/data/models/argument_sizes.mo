// Sizes of arguments are those of the inputs (MLS 3.6 sec. 10.1, 12.4.1), as far as they are known at translation.
package ArgumentSizes
  function norm3 input Real v[3]; output Real n = sqrt(v*v); end norm3;
  function mean input Integer n; input Real v[n]; output Real m = sum(v)/n; end mean;
  function dot
    input Real a[:];
    input Real b[size(a, 1)];
    output Real s = 0;
  algorithm
    for i in 1:size(a, 1) loop
      s := s + a[i]*b[i];
    end for;
  end dot;
  function total input Real m[:, 2]; output Real y = sum(m); end total;
  function product input Real v[3] = {1, 2, 3}; input Real m[size(v, 1), 2*size(v, 1)]; output Real y = sum(m); end product;
  function shorter input Real x[:]; output Real y; algorithm y := mean(size(x, 1) - 1, x); end shorter;
  function ofThree
    input Real x[:];
    output Real y;
  algorithm
    if size(x, 1) == 3 then
      y := norm3(x);
    else
      y := 0;
    end if;
  end ofThree;
  record R Real v[3]; end R;
  record N parameter Integer n = 2; Real x[n]; end N;
  function first input R r; output Real y = r.v[1]; end first;
  function ofRecord input N r; input Real z[r.n]; output Real y = sum(z); end ofRecord;
  package Right
    model Fixed Real y = norm3({2, 3, 6}*time); end Fixed;
    model Parameter parameter Integer n = 3; Real y = mean(n, {time, 2, 3}); end Parameter;
    model EachRow Real y[2] = mean(3, [time, 2, 3; 4, 5, 6]); end EachRow;
    model EachNumber Real y[2] = mean({3, 3}, [time, 2, 3; 4, 5, 6]); end EachNumber;
    model Nothing Real y = total(zeros(0, 2)); end Nothing;
    model Derived Real y = product(m = time*ones(3, 6)); end Derived;
    model NotTaken Real y = ofThree({time, 1}); end NotTaken;
    model OfRecord Real y = ofRecord(N(2, {time, 2}), {1, 2}); end OfRecord;
    model Varying Integer n(start = 3, fixed = true); Real y = mean(n, {time, 2, 3}); equation when time > 2 then n = 4; end when; end Varying;
  end Right;
  package Wrong
    model Fixed Real y = norm3({1, 1, 1, 1}*time); end Fixed;
    model OfInput Real y = mean(4, {1, 2, 3}); end OfInput;
    model Parameter parameter Integer n = 4; Real y = mean(n, {1, 2, 3}); end Parameter;
    model OfArray Real y = dot({1, 2}, {3, 4, 5}); end OfArray;
    model Named Real y = dot(b = {3, 4, 5}, a = {1, 2}); end Named;
    model Column Real y = total([1, 2, 3]); end Column;
    model Vector Real y = total({1, 2}); end Vector;
    model Derived Real y = product(m = ones(3, 5)); end Derived;
    model EachRow Real y[2] = mean(2, [1, 2, 3; 4, 5, 6]); end EachRow;
    model Inside Real y = shorter({time, 1}); end Inside;
    model Record Real y = first(R({1, 2})); end Record;
    model OfRecord Real y = ofRecord(N(2, {1, 2}), {1, 2, 3}); end OfRecord;
    model Statement Real y; algorithm y := norm3({time, 2}); end Statement;
  end Wrong;
end ArgumentSizes;
