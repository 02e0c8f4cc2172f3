function Turnier "je zwei Zufallige treten an, der Bessere vererbt"
  input Real Bevoelkerung[:,:];
  input Real Guete[:];
  input Real Lose[:];
  output Real Eltern[size(Bevoelkerung, 1), size(Bevoelkerung, 2)];
protected
  Integer n = size(Bevoelkerung, 1);
  Integer i;
  Integer j;
algorithm
  for k in 1:n loop
    i := 1 + integer(n*Lose[2*k - 1]);
    j := 1 + integer(n*Lose[2*k]);
    if Guete[i] <= Guete[j] then
      Eltern[k,:] := Bevoelkerung[i,:];
    else
      Eltern[k,:] := Bevoelkerung[j,:];
    end if;
  end for;
end Turnier;
