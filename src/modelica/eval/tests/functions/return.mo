function first input Real x[:]; output Integer y;
algorithm
  for i in 1:size(x, 1) loop
    while true loop
      if x[i] > 0 then y := i; return; end if;
      break;
    end while;
  end for;
  y := 0;
end first;
