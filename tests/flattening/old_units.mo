// Units that do not fit, in a library that shows its age: told once, where units of a library of
// today are told at every place (`units.mo`).
package old_units
  annotation(Coordsys(extent=[0, 0; 442, 386]));
  type Length = Real(final unit = "m");
  type Time = Real(final unit = "s");
  model Main
    parameter Length da = 1;
    parameter Time t0 = 2;
    Length x;
    Time t;
  equation
    x = t0;
    t = da + t0;
  end Main;
end old_units;
