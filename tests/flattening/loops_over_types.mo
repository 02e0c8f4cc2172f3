// MLS §11.2.2.1: a loop without a range runs over the values of the type that sizes the dimension.
package loops_over_types
  type Colour = enumeration(red, green, blue);
  model Main
    Boolean same[Boolean];
    Real depth[Colour];
    Real mixed[Boolean, 2];
    Real numbered[Colour] = {1, 2, 3};
  equation
    for truth loop
      same[truth] = truth;
    end for;
    for c loop
      depth[c] = 2*numbered[c];
    end for;
    for truth, i loop
      mixed[truth, i] = if truth then i else -i;
    end for;
  end Main;
end loops_over_types;
