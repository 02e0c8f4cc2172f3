// before
/* and
   more */ model /* between */ M // "not a string
  Real x /* 'not an ident */ = 1; // behind
  Real y = "// not a comment /* neither */";
end M; // last
