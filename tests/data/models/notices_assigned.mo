model W
  impure function write
    input String file;
    input String name;
    input Real matrix[:, :];
    input Boolean append = false;
    output Boolean done;
    external "C" done = ModelicaIO_writeRealMatrix(
      file, name, matrix, size(matrix, 1), size(matrix, 2), append, "4");
  end write;
  Real x(start = 0, fixed = true);
  discrete Boolean first, second, later(start = false, fixed = true), never(start = false, fixed = true);
  Boolean other(start = false, fixed = true);
equation
  der(x) = 1;
  when x > 0.5 then
    other = write("other.mat", "A", [x]);
  end when;
  when terminal() then
    assert(first and second and later and other and not never, "what was written");
  end when;
algorithm
  when initial() then
    first := write("all.mat", "A", [1]);
    second := write("all.mat", "B", [2], append=true);
  end when;
  when x > 0.25 then
    if x < 10 then
      later := write("all.mat", "C", [x], append=true);
    else
      never := write("never.mat", "A", [x]);
    end if;
  end when;
end W;
