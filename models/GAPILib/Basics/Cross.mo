within GAPILib.Basics;
function Cross "Elites and children: adjacent ranks exchange the genes behind each crossing point"
  input Integer Parents "number of population parents";
  input Integer Elitism "number of elitism individuals";
  input Real OldGeneration[:,:] "old generation of population ordered by fitness";
  // added
  input Integer Cross_Point[:] = {div(size(OldGeneration, 2), 2)} "crossing points";
  output Real NewGeneration_Cross[Elitism + Parents,size(OldGeneration, 2)] "elites first, unaltered, then the children";
protected
  Integer mate;
  Boolean exchanged;
algorithm
  assert(Parents >= 1 and Elitism >= 0 and Parents + Elitism <= size(OldGeneration, 1),
    "Parents + Elitism is more than the number of individuals");
  for point in Cross_Point loop
    assert(point >= 0 and point <= size(OldGeneration, 2), "a crossing point lies outside the genome");
  end for;
  NewGeneration_Cross[1:Elitism,:] := OldGeneration[1:Elitism,:];
  for k in 1:Parents loop
    mate := if mod(k, 2) == 0 then k - 1 elseif k < Parents then k + 1 else 1;
    exchanged := false;
    for j in 1:size(OldGeneration, 2) loop
      for point in Cross_Point loop
        exchanged := if point == j - 1 then not exchanged else exchanged;
      end for;
      NewGeneration_Cross[Elitism + k,j] := OldGeneration[if exchanged then mate else k,j];
    end for;
  end for;
  annotation(Documentation(info = "<html>
<p>The parents are the best <code>Parents</code> individuals. Ranks (1, 2), (3, 4), ... make two
children each [D]; an odd last parent mates with rank 1 and gives the first child of that pair [D].
With one crossing point c the children of a and b are</p>
<pre>
(a(1) ... a(c)  b(c+1) ... b(n))     (b(1) ... b(c)  a(c+1) ... a(n))
</pre>
<p>With several points the genes behind each of them are exchanged in turn, so that with two points
the genes between them change places. The points are drawn once, when the run is initialized.</p>
<p>Reference: Rubio et al. 2006, Figure 3 and Table 2.</p>
</html>"));
end Cross;
