model One
  Basics.twice load;
  Basics.Loads.Step step(high = F);
equation
  load.i = step.y;
end One;
