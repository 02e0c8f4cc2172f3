within GAPILib.Basics;
function Mutation "Replaces genes, each with the probability F_Mut, by random values"
  input Real Nparameters[:,:] "complete population parameters of NewGeneration_Cross";
  input Real F_Mut "mutation factor, 0 to 1";
  input Real RamMut[:,:] "pseudo-random numbers: one for each gene, shaped like Nparameters, or all in one row";
  // added
  input Real Param_Min[size(Nparameters, 2)] = {min(Nparameters[:,j]) for j in 1:size(Nparameters, 2)} "lower ends of the search ranges";
  input Real Param_Max[size(Nparameters, 2)] = {max(Nparameters[:,j]) for j in 1:size(Nparameters, 2)} "upper ends of the search ranges";
  input Integer Elitism = 0 "rows at the top that stay";
  output Real NewGeneration_Mut[size(Nparameters, 1),size(Nparameters, 2)] "population obtained after elitism, crossover and mutation";
protected
  Boolean in_one_row = size(RamMut, 1) == 1 and size(Nparameters, 1) <> 1;
  Integer n = size(Nparameters, 2);
  Real u "the number of this gene";
algorithm
  assert(F_Mut >= 0 and F_Mut <= 1, "F_Mut is no probability");
  assert(Elitism >= 0 and Elitism <= size(Nparameters, 1), "Elitism is not within the population");
  for j in 1:n loop
    assert(Param_Min[j] <= Param_Max[j], "search range " + String(j) + " is empty");
  end for;
  NewGeneration_Mut := Nparameters;
  for k in Elitism + 1:size(Nparameters, 1) loop
    for j in 1:n loop
      u := if in_one_row then RamMut[1,(k - 1)*n + j] else RamMut[k,j];
      if u < F_Mut then
        NewGeneration_Mut[k,j] := min(Param_Min[j] + (Param_Max[j] - Param_Min[j])*u/F_Mut, Param_Max[j]);
      end if;
    end for;
  end for;
  annotation(Documentation(info = "<html>
<p>Mutation is per gene, and one number decides both whether and what: gene j of individual k mutates
when <code>u(k,j) &lt; F_Mut</code>, and its value is then</p>
<pre>
Param_Min(j) + (Param_Max(j) - Param_Min(j)) u(k,j)/F_Mut
</pre>
<p>which is uniform over the search range [D]. <code>F_Mut = 0</code> changes nothing,
<code>F_Mut = 1</code> everything. <code>RamMut</code> may be the row that
<code>Ram_Gen_ARENA</code> gives, read individual by individual [D]. Without search ranges the
range that the population itself spans is used [D].</p>
<p>Reference: Rubio et al. 2006, section 3.2 and Table 2.</p>
</html>"));
end Mutation;
