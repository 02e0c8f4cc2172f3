model W
  impure function write
    input String file;
    input String name;
    input Real matrix[:, :];
    output Boolean done;
    external "C" done = ModelicaIO_writeRealMatrix(
      file, name, matrix, size(matrix, 1), size(matrix, 2), false, "4");
  end write;
  impure function tell
    input String text;
    input String file;
    external "C" ModelicaInternal_print(text, file);
  end tell;
  impure function twice
    input Real number;
  algorithm
    tell("number " + String(2*number), "log.txt");
  end twice;
  parameter Integer method = 1;
  Real x(start = 0, fixed = true);
  Integer n(start = 0, fixed = true);
equation
  der(x) = 1;
  when {x > 0.25, x > 0.5} then
    n = pre(n) + 1;
    tell("event", "log.txt");
    twice(n);
  end when;
algorithm
  when terminal() then
    if method == 1 then
      write("end.mat", "A", [x, n; 3, 4]);
    end if;
  end when;
end W;