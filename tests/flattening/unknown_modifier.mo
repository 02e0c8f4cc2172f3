// MLS §7.2: a modifier names an element that is there.
package unknown_modifier
  model Part
    parameter Real resistance = 1;
  end Part;
  model Main
    Part p(resistence = 2);
  end Main;
end unknown_modifier;
