within CaseStudies.Water;
model Channel "Gas channel of the cathode"
  Gas gas "diffusion layer";
  outer Properties properties;
equation
  gas.p = properties.P;
  gas.w = properties.RHc*properties.psat;
  gas.s = 0;
end Channel;
