// MLS §12: functions with defaults, arrays of any size, calls of other functions.
package functions
  function square
    input Real x;
    output Real y = x^2;
  end square;
  function norm
    input Real v[:];
    input Real p = 2;
    output Real r;
  protected
    Real s = 0;
  algorithm
    for i in 1:size(v, 1) loop
      s := s + square(v[i])^(p/2);
    end for;
    r := s^(1/p);
  end norm;
  model Main
    Real x = norm({time, 2});
  end Main;
end functions;
