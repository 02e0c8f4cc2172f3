package Media
  partial package Medium
    replaceable partial function density input Real T; output Real d; end density;
    constant Real M = 0.018;
    model Base Real T, d; equation d = density(T); end Base;
  end Medium;
  package Water extends Medium(M = 0.02);
    redeclare function extends density algorithm d := 1000 - 0.1*T*M; end density;
  end Water;
  model Tank
    replaceable package Medium = Water constrainedby Media.Medium;
    outer Real ambient; Medium.Base medium(T = ambient);
  end Tank;
  model Top inner Real ambient = 293 + time; Tank tank; Tank tanks[2]; end Top;
end Media;
model Top extends Media.Top; end Top;
