within CaseStudies.Water;
model MembraneVolume "Water in a part of a membrane"
  Ionomer water(lambda(start = properties.lambda0, fixed = true)) "what flows in";
  outer Properties properties;
  outer parameter Units.Length h;
equation
  properties.cf*h*der(water.lambda) = water.J;
end MembraneVolume;
