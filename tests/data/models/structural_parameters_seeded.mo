model M
  function seed
    input Integer state[33];
    input Integer n;
    input Integer id;
    external "C" ModelicaRandom_setInternalState_xorshift1024star(state, n, id);
  end seed;
  function draw
    input Integer id;
    output Real y;
    external "C" y = ModelicaRandom_impureRandom_xorshift1024star(id);
  end draw;
  function size_of_sample
    output Integer n;
  algorithm
    seed({i * i for i in 1:33}, 33, 4321);
    n := 2 + integer(8 * draw(4321));
  end size_of_sample;
  parameter Integer n = size_of_sample();
  Real v[n] = {i * time for i in 1:n};
  Real x = n;
end M;
