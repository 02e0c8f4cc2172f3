model Ends
  function all_of input Boolean b[:]; output Boolean r = min(b); algorithm annotation(Inline = true);
  end all_of;
  function any_of input Boolean b[:]; output Boolean r; algorithm
    for i in 1:2 loop r := max(b); end for;
  end any_of;
  parameter Integer n = 0;
  Boolean v[n];
  Real truths[:] = {if all_of(fill(false, 0)) == true then 1 else 0,
    if any_of(fill(true, 0)) == false then 1 else 0,
    if min(v) == true and max(v) == false then 1 else 0};
  Integer k[n];
  Boolean ends = max(k) < min(k);
  Real x = sum(truths) + (if ends then 1 else 0);
end Ends;
