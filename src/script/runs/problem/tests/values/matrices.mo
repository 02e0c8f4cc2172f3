model Oven
  parameter Real G = 2;
  parameter Real C = 500;
  parameter Real tau = C/G;
  Real T[3](each start = 20, each fixed = true);
  output Real Tm = T[3];
equation
  for i in 1:3 loop
    C*der(T[i]) = -G*T[i];
  end for;
end Oven;
