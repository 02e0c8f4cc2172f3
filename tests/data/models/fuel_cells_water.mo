model Test
  extends CaseStudies.WaterEffect;
  Real anodeGave(start = 0, fixed = true);
  Real formed(start = 0, fixed = true);
  Real left(start = 0, fixed = true);
  Real held;
equation
  der(anodeGave) = -anode.water.J;
  der(formed) = -load.i/(2*96485);
  der(left) = channel.gas.jW + channel.gas.jL;
  held = properties.cf*membrane.h*sum(membrane.c.water.lambda)
    + active.h*active.eps*sum(properties.cw*active.c.gas.s
      + (ones(n + 1) - active.c.gas.s).*active.c.gas.w/properties.RT)
    + diffusion.h*diffusion.eps*sum(properties.cw*diffusion.c.gas.s
      + (ones(n + 1) - diffusion.c.gas.s).*diffusion.c.gas.w/properties.RT);
end Test;
