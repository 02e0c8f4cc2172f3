within Modelica.Math;
package Random "Random numbers"
  extends Modelica.Icons.Package;

  package Generators "Generators of random numbers"
    extends Modelica.Icons.Package;

    package Xorshift64star "The generator xorshift64*: 64 bits of state"
      extends Modelica.Icons.Package;
      constant Integer nState = 2 "Integers of a state";

      function initialState "A state of two seeds"
        extends Modelica.Icons.Function;
        input Integer localSeed "seed of this stream of numbers";
        input Integer globalSeed "seed of all streams";
        output Integer state[nState] "state";
      protected
        Real r "number that is not used";
      algorithm
        state := if localSeed == 0 and globalSeed == 0 then {126247697, globalSeed} else {localSeed, globalSeed};
        for i in 1:10 loop
          (r, state) := random(state);
        end for;
      end initialState;

      function random "The next number, equally distributed between 0 and 1"
        extends Modelica.Icons.Function;
        input Integer stateIn[nState] "state";
        output Real result "number, 0 < result <= 1";
        output Integer stateOut[nState] "state behind it";
        external "C" ModelicaRandom_xorshift64star(stateIn, stateOut, result);
      end random;
    end Xorshift64star;

    package Xorshift128plus "The generator xorshift128+: 128 bits of state"
      extends Modelica.Icons.Package;
      constant Integer nState = 4 "Integers of a state";

      function initialState "A state of two seeds"
        extends Modelica.Icons.Function;
        input Integer localSeed "seed of this stream of numbers";
        input Integer globalSeed "seed of all streams";
        output Integer state[nState] "state";
      algorithm
        state := Utilities.initialStateWithXorshift64star(localSeed, globalSeed, nState);
      end initialState;

      function random "The next number, equally distributed between 0 and 1"
        extends Modelica.Icons.Function;
        input Integer stateIn[nState] "state";
        output Real result "number, 0 < result <= 1";
        output Integer stateOut[nState] "state behind it";
        external "C" ModelicaRandom_xorshift128plus(stateIn, stateOut, result);
      end random;
    end Xorshift128plus;

    package Xorshift1024star "The generator xorshift1024*: 1024 bits of state and a position"
      extends Modelica.Icons.Package;
      constant Integer nState = 33 "Integers of a state";

      function initialState "A state of two seeds"
        extends Modelica.Icons.Function;
        input Integer localSeed "seed of this stream of numbers";
        input Integer globalSeed "seed of all streams";
        output Integer state[nState] "state";
      algorithm
        state[1:32] := Utilities.initialStateWithXorshift64star(localSeed, globalSeed, 32);
        state[33] := 0;
      end initialState;

      function random "The next number, equally distributed between 0 and 1"
        extends Modelica.Icons.Function;
        input Integer stateIn[nState] "state";
        output Real result "number, 0 < result <= 1";
        output Integer stateOut[nState] "state behind it";
        external "C" ModelicaRandom_xorshift1024star(stateIn, stateOut, result);
      end random;
    end Xorshift1024star;
  end Generators;

  package Utilities "Seeds, and random numbers with a state that is not seen"
    extends Modelica.Icons.Package;

    function initialStateWithXorshift64star "A state of any size of two seeds"
      extends Modelica.Icons.Function;
      input Integer localSeed "seed of this stream of numbers";
      input Integer globalSeed "seed of all streams";
      input Integer nState(min = 1) "Integers of the state";
      output Integer state[nState] "state";
    protected
      Integer pair[2] "state of xorshift64*";
      Integer at "where the next pair goes";
      Real r "number that is not used";
    algorithm
      pair := Generators.Xorshift64star.initialState(localSeed, globalSeed);
      at := 1;
      while at <= nState loop
        state[at] := pair[1];
        if at < nState then
          state[at + 1] := pair[2];
        end if;
        (r, pair) := Generators.Xorshift64star.random(pair);
        at := at + 2;
      end while;
    end initialStateWithXorshift64star;

    function automaticGlobalSeed "A seed for all streams"
      extends Modelica.Icons.Function;
      output Integer seed "seed, the same in every run";
      external "C" seed = ModelicaRandom_automaticGlobalSeed(0.0);
    end automaticGlobalSeed;

    function automaticLocalSeed "A seed of the path of a component"
      extends Modelica.Icons.Function;
      input String path "path, as getInstanceName() gives it";
      output Integer seed "seed";
    algorithm
      seed := Modelica.Utilities.Strings.hashString(path);
    end automaticLocalSeed;

    impure function initializeImpureRandom "The hidden state of a seed"
      extends Modelica.Icons.Function;
      input Integer seed "seed";
      output Integer id "what impureRandom wants";
    protected
      Integer state[33] "state of xorshift1024*";
      function setInternalState "Sets the hidden state"
        extends Modelica.Icons.Function;
        input Integer state[33] "state";
        input Integer id "identification";
        external "C" ModelicaRandom_setInternalState_xorshift1024star(state, size(state, 1), id);
      end setInternalState;
    algorithm
      state := Generators.Xorshift1024star.initialState(seed, 715827883);
      id := 715827883;
      setInternalState(state, id);
    end initializeImpureRandom;

    impure function impureRandom "The next number of the hidden state, between 0 and 1"
      extends Modelica.Icons.Function;
      input Integer id "of initializeImpureRandom";
      output Real y "number";
      external "C" y = ModelicaRandom_impureRandom_xorshift1024star(id);
    end impureRandom;

    impure function impureRandomInteger "The next whole number of the hidden state"
      extends Modelica.Icons.Function;
      input Integer id "of initializeImpureRandom";
      input Integer imin = 1 "the least";
      input Integer imax = 1000000 "the greatest";
      output Integer y "number";
    algorithm
      y := min(imax, imin + integer(impureRandom(id)*(imax - imin + 1)));
    end impureRandomInteger;
  end Utilities;
end Random;
