package Asks
  model M = Ordered.Zero;
  annotation(uses(Ordered(version = "1.2.0")));
end Asks;
