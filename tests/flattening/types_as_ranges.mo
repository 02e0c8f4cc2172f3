// MLS §10.1, §10.5, §11.2.2.2: enumerations and Boolean as sizes, subscripts and ranges.
package types_as_ranges
  type Logic = enumeration(low, high, unknown);
  constant Integer table[Logic, Logic] = [1, 2, 3; 4, 5, 6; 7, 8, 9];
  model Main
    Real x[Logic];
    Real y[Boolean];
    parameter Logic start = Logic.high;
    Integer picked = table[Logic.high, Logic.unknown];
    Real z = x[start] + y[true];
    Logic converted = Logic(3);
  equation
    for l in Logic loop
      x[l] = if l == Logic.low then 0 else x[Logic.low] + 1;
    end for;
    for b in Boolean loop
      y[b] = if b then 1 else 0;
    end for;
  end Main;
end types_as_ranges;
