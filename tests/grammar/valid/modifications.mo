model M
  A a(x = 1, each final y(start = 2, fixed = true) = 3, z.w = 4 "old", each p, q());
  A b(redeclare B c(x = 1) = d "why", redeclare each final replaceable model N = P(x = 1) constrainedby Q(y = 2), replaceable R r);
  A c(redeclare function f = g, redeclare type E = enumeration(one, two), x := 3);
  A d(y = if a then b else c);
end M;
