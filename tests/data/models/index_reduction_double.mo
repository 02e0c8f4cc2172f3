model Double parameter Real g = 9.81;
      Real x1(start = 1, fixed = true); Real y1(start = 0); Real u1; Real v1(start = 0, fixed = true);
      Real x2(start = 1, fixed = true); Real y2(start = -1); Real u2(start = 0, fixed = true); Real v2; Real F1; Real F2;
      Real a(start = asin(1.0), fixed = true); Real b(start = 0, fixed = true); Real p(fixed = true); Real q(fixed = true); Real d;
    equation
      der(x1) = u1; der(y1) = v1; der(x2) = u2; der(y2) = v2;
      der(u1) = -F1*x1 + F2*(x2 - x1); der(v1) = -F1*y1 + F2*(y2 - y1) - g;
      der(u2) = -F2*(x2 - x1); der(v2) = -F2*(y2 - y1) - g;
      x1^2 + y1^2 = 1; (x2 - x1)^2 + (y2 - y1)^2 = 1;
      d = a - b; der(a) = p; der(b) = q;
      2*der(p) + der(q)*cos(d) + q^2*sin(d) + 2*g*sin(a) = 0;
      der(q) + der(p)*cos(d) - p^2*sin(d) + g*sin(b) = 0;
    end Double;