model P
Real level(start = 0, fixed = true) "left"; Real m; Real a(start = 3); Real b(start = 3); Real s;
Boolean inflow; Integer n(start = 0, fixed = true);
equation
der(level) = 1;
m = 2*(a - b) + 0.1*(a - b)^3;
0 = if level >= 5 then a - 1 - level else m;
inflow = s > 0;
0 = if inflow then b - 1 else m;
s = if inflow then m else b - 1;
when sample(1, 1) then n = pre(n) + 1; end when; end P;
