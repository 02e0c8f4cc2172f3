
  function sum_up
    input Real x;
    output Real y;
  protected
    Real sum;
  algorithm
    for i in 1:3 loop
      sum := sum + i * x;
    end for;
    y := sum;
  end sum_up;
  function branch
    input Real x;
    output Real y;
  algorithm
    if x > 0.5 then
      y := x;
    end if;
  end branch;
  function nested
    input Real x;
    output Real y;
  protected
    Real v[3];
  algorithm
    v[2] := x;
    y := 2 * branch(x) + sum(v);
  end nested;
  function root
    input Real x;
    output Real y;
  protected
    Real v[2];
  algorithm
    v[1] := x;
    y := 2 * sqrt(v * v);
  end root;
  function seed
    input Integer state[33];
    input Integer n;
    input Integer id;
    external "C" ModelicaRandom_setInternalState_xorshift1024star(state, n, id);
  end seed;
  function next
    input Integer id;
    output Real y;
    external "C" y = ModelicaRandom_impureRandom_xorshift1024star(id);
  end next;
  impure function draw
    input Real x;
    output Real y;
  protected
    Real sum;
    Real both[2];
  algorithm
    seed({i * i for i in 1:33}, 33, 4321);
    both := {next(4321), next(4321)};
    seed({i * i for i in 1:33}, 33, 4321);
    y := x + sum + both[1] - next(4321);
  end draw;
  function all_assigned
    input Real x;
    output Real y;
  protected
    Real v[2];
  algorithm
    for i in 1:2 loop
      v[i] := i * x;
    end for;
    y := v[1] + v[2];
  end all_assigned;