function next
  input Real ordered[:,:];
  input Integer parents;
  input Integer elites;
  input Real low[:];
  input Real high[:];
  input Real u[:];
  output Real new[size(ordered, 1), size(ordered, 2)];
protected
  Integer n = size(ordered, 1);
  Integer m = size(ordered, 2);
  Integer changed = parents + elites;
  Real crossed[parents + elites, size(ordered, 2)];
  Real lots[parents + elites, size(ordered, 2)];
algorithm
  crossed := GAPILib.Basics.Cross(parents, elites, ordered);
  for i in 1:changed loop
    lots[i,:] := u[(i - 1)*m + 1:i*m];
  end for;
  new[1:changed,:] := GAPILib.Basics.Mutation(crossed, 0.25, lots, low, high, elites);
  for i in changed + 1:n loop
    new[i,:] := low + (high - low) .* u[(i - 1)*m + 1:i*m];
  end for;
end next;
