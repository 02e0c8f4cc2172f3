model M
  function lines
    input String file;
    output Integer n;
    external "C" n = ModelicaInternal_countLines(file);
  end lines;
  discrete Integer k(start = 0, fixed = true);
equation
  when sample(1, 1) then
    k = lines("data" + String(pre(k)) + ".txt");
  end when;
end M;
