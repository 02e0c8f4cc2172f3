model M
  parameter Real p = 1;
  Real x(start = 1, fixed = true);
  Real product, root, slope, y(start = 1);
  Boolean both, one;
equation
  der(x) = 1;
  product = terms_of_product;
  root = sqrt(terms_of_root);
  slope = der(root);
  0 = 8 - y^3 + terms_of_cube;
  both = terms_of_both;
  one = terms_of_one;
end M;
