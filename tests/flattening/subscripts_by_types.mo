// MLS §10.5 and §11.2.2.1: dimensions sized by an enumeration or by Boolean have subscripts of that
// type; a loop without a range runs over the values of the type.
package subscripts_by_types
  type Colour = enumeration(red, green, blue);
  model Main
    Boolean same[Boolean];
    Real depth[Colour];
    Real mixed[Boolean, 2];
    Real numbered[Colour] = {1, 2, 3};
    Real wrong = numbered[2];
    Real also = mixed[1, 2];
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
end subscripts_by_types;
