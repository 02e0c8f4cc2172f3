model Buffer
  Integer n(start = 0, fixed = true);
  Real values[3](each start = 0, each fixed = true);
  Real pairs[2, 2](each start = 0, each fixed = true);
algorithm
  when sample(0.5, 1) then
    n := mod(pre(n), 3) + 1;
    values[n] := time;
    pairs[if n > 1 then 2 else 1, :] := {time, n};
  end when;
end Buffer;
