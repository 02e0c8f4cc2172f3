within GAPILib.Basics;
function Ram_Gen_ARENA "Pseudo-random numbers of the generator that Arena uses (MRG32k3a)"
  input Real Seed[1,6] "seed {x(n-3), x(n-2), x(n-1), y(n-3), y(n-2), y(n-1)}";
  input Integer N_Ram "number of pseudo-random numbers to generate";
  output Real Ram_list[1,N_Ram] "numbers uniform between 0 and 1, both excluded";
  // added
  output Real Seed_Next[1,6] "state after N_Ram draws: feed it to the next call";
protected
  constant Real m1 = 4294967087 "modulus of the first recurrence";
  constant Real m2 = 4294944443 "modulus of the second recurrence";
  constant Real norm = 2.328306549295727688e-10 "1/(m1 + 1)";
  Real s[6] "the state";
  Real x "next value of the first recurrence";
  Real y "next value of the second recurrence";
algorithm
  s := Seed[1,:];
  for k in 1:6 loop
    assert(s[k] == floor(s[k]) and s[k] >= 0 and s[k] < (if k <= 3 then m1 else m2),
      "entry " + String(k) + " of the seed is no whole number in its range");
  end for;
  assert(s[1] <> 0 or s[2] <> 0 or s[3] <> 0, "entries 1 to 3 of the seed are all 0");
  assert(s[4] <> 0 or s[5] <> 0 or s[6] <> 0, "entries 4 to 6 of the seed are all 0");
  for k in 1:N_Ram loop
    // All products stay below 2^53: the arithmetic in Reals is exact.
    x := mod(1403580*s[2] - 810728*s[1], m1);
    y := mod(527612*s[6] - 1370589*s[4], m2);
    s := {s[2], s[3], x, s[5], s[6], y};
    Ram_list[1,k] := (if x > y then x - y else x - y + m1)*norm;
  end for;
  Seed_Next := {s};
  annotation(Documentation(info = "<html>
<p>Two recurrences of order three</p>
<pre>
x(n) = (1403580 x(n-2) -  810728 x(n-3)) mod 4294967087
y(n) = ( 527612 y(n-1) - 1370589 y(n-3)) mod 4294944443
</pre>
<p>are combined to <code>u = ((x - y) mod m1)/(m1 + 1)</code>, where the difference 0 counts as
<code>m1</code>. The period is about 2^191. The first three entries of the seed lie in
0..4294967086 and are not all 0, the last three lie in 0..4294944442 and are not all 0; the usual
seed is <code>[12345, 12345, 12345, 12345, 12345, 12345]</code>.</p>
<p>The function keeps no state: the second output <code>Seed_Next</code> [D] is the seed of the next
call, so that <code>(Ram_list, Seed) := Ram_Gen_ARENA(Seed, 10)</code> draws ten numbers and goes
on behind them the next time.</p>
<h4>References</h4>
<p>P. L'Ecuyer: Good parameters and implementations for combined multiple recursive random number
generators. Operations Research 47(1), 1999.<br>
P. L'Ecuyer, R. Simard, E. J. Chen, W. D. Kelton: An object-oriented random-number package with
many long streams and substreams. Operations Research 50(6), 2002.<br>
Rubio et al. 2006, section 3.1 and Table 2.</p>
</html>"));
end Ram_Gen_ARENA;
