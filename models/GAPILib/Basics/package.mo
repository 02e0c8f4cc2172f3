within GAPILib;
package Basics "The functions that the scripts of GAPILib call"
  annotation(Documentation(info = "<html>
<p>One generation consists of <code>N_Elitism</code> elites, <code>N_Parents</code> children and
<code>N_Population - N_Elitism - N_Parents</code> random individuals, in this order; the random
ones are added after mutation [D]. A population is a matrix with one individual in each row and
one parameter in each column.</p>
<p>A row vector <code>[1, n]</code> and a vector <code>[n]</code> hold the same numbers for the
built-in functions; the functions here take what their declarations say.</p>
<p>Reference: Rubio et al. 2006, Table 2.</p>
</html>"));
end Basics;
