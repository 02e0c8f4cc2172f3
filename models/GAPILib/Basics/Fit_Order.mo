within GAPILib.Basics;
function Fit_Order "Sorts the individuals by their fitness, best first"
  input Real Pop[:,:] "population to be ordered";
  input Real Fit[size(Pop, 1)] "fitness of all population";
  input Integer Population "number of population individuals";
  input Integer Parents "number of population parents";
  input Integer Elitism "number of elitism individuals";
  output Real Pop_Ordered[size(Pop, 1),size(Pop, 2)] "population sorted by fitness value; ties keep their order";
  // added
  output Real Fit_Ordered[size(Pop, 1)] "the fitness in the same order";
protected
  Integer rank[size(Pop, 1)] = {k for k in 1:size(Pop, 1)} "rank[k]: the individual at position k";
  Integer candidate;
  Integer position;
algorithm
  assert(Population == size(Pop, 1), "Population is not the number of rows of Pop");
  assert(Parents >= 1 and Elitism >= 0 and Parents + Elitism <= Population,
    "Parents + Elitism is more than Population");
  for k in 1:size(Pop, 1) loop
    // Insertion: behind every individual that is as good or better.
    candidate := k;
    position := k;
    while position > 1 and Fit[rank[max(position - 1, 1)]] > Fit[candidate] loop
      rank[position] := rank[position - 1];
      position := position - 1;
    end while;
    rank[position] := candidate;
  end for;
  for k in 1:size(Pop, 1) loop
    Pop_Ordered[k,:] := Pop[rank[k],:];
    Fit_Ordered[k] := Fit[rank[k]];
  end for;
  annotation(Documentation(info = "<html>
<p>Selection is truncation: after sorting, the first <code>Parents</code> rows are the parents and
the first <code>Elitism</code> rows the elites [D]. Individuals of equal fitness keep their order
[D].</p>
<p>Reference: Rubio et al. 2006, section 3.2 and Table 2.</p>
</html>"));
end Fit_Order;
