package Newest
  model M = Ordered.Zero;
end Newest;
