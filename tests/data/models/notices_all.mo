function all
  input Real x;
  output Boolean done;
algorithm
  done := write("a.mat", "A", [x]);
  if x < 0 then
    done := write("b.mat", "A", [x]);
  end if;
  done := write("c.mat", "A", [2*x]);
end all;
