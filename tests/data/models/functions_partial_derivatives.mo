model M
  function f input Real x; input Real y; output Real z;
  algorithm assert(x >= 0, "negative"); z := x^2*y + sin(x); end f;
  function fx = der(f, x);
  function fxy = der(f, x, y);
  function s input Real x; input Integer n; output Real s;
  algorithm s := 0; for i in 1:n loop s := s + x^i; end for; annotation(Inline = false); end s;
  function sx = der(s, x);
  function root input Real x; output Real s;
  algorithm s := 1; while s*s < x loop s := s + 0.5*x; end while; end root;
  function root_x = der(root, x);
  function total input Real x; output Real y;
  algorithm y := 0; for i in 1:3 loop y := y + fx(x, i); end for; end total;
  Real a = fx(time, 3);
  Real b = fxy(time, 2);
  Real c = sx(time, 4);
  Real d = total(time);
  Real e = root_x(5 + time);
end M;
