package P
  function f
    input Real x;
    output Real y;
    external "C" y = f_c(x, size(x, 1)) annotation(Library = "f", Include = "#include <f.h>");
    annotation(derivative = df);
  end f;
  function g
    external "builtin";
  end g;
  function h
    external;
    annotation(a = 1);
    annotation(b = 1);
  end h;
end P;
