record Pole
  Real re;
  Real im;
end Pole;
record Factors
  Real first[:];
  Real second[:];
end Factors;
function real_poles
  input Pole p[:];
  output Integer n;
algorithm
  n := 0;
  for i in 1:size(p, 1) loop
    if p[i].im == 0 then
      n := n + 1;
    end if;
  end for;
end real_poles;
function factors
  input Pole p[:];
  output Factors f(redeclare Real first[real_poles(p)], redeclare Real second[size(p, 1) - real_poles(p)]);
protected
  Integer n = size(f.first, 1);
  Integer j = 0;
  Integer k = 0;
algorithm
  for i in 1:size(p, 1) loop
    if p[i].im == 0 then
      j := j + 1;
      f.first[j] := p[i].re;
    else
      k := k + 1;
      f.second[k] := p[i].im;
    end if;
  end for;
end factors;
model M
  parameter Factors f = factors({Pole(3, 0), Pole(1, 5), Pole(7, 0)});
  Real x = sum(f.first) + 100*f.second[1]*time + 1000*size(f.first, 1);
end M;
