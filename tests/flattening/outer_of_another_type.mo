// MLS §5.4: the inner component has the type and the dimensions of the outer one.
package outer_of_another_type
  type E = enumeration(one, two);
  type F = enumeration(two, three);
  model Part
    outer Integer n;
    outer Real v[2];
    outer E e;
    outer Real fits;
    Real x = fits;
  end Part;
  model Main
    inner Real n = 1;
    inner Real v = 2;
    inner F e = F.two;
    inner Real fits = 3;
    Part part;
  end Main;
end outer_of_another_type;
