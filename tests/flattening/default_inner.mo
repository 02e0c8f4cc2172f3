// MLS §5.4: without an inner component the model gets one, with a warning; a variable becomes an
// input. So the parts of a library can be checked one by one.
package default_inner
  model World
    parameter Real g = 9.81;
  end World;
  model Part
    outer World world;
    outer parameter Real da = 1;
    outer Real T;
    Real x = world.g*da*T;
  end Part;
  model Main
    outer World world;
    outer Real T;
    Part part[2];
    Real y = world.g + T;
  end Main;
end default_inner;
