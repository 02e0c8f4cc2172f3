model Grows
  function positive
    input Real x[:];
    output Real y[:];
  algorithm
    for i in 1:size(x, 1) loop
      if x[i] > 0 then
        y := cat(1, y, x[i:i]);
      end if;
    end for;
  end positive;
  parameter Real a[:] = {-2, 1, 0, -1, 2} annotation(Evaluate = true);
  parameter Real x[:] = positive(a);
equation
  assert(size(x, 1) == 2 and x[2] == 2, "not the positive ones");
end Grows;
