package Own "Operators written in Modelica; most do what one of the tables does"
  function uniformSampling "as uniform"
    input Real random[:];
    input Real minimum[:];
    input Real maximum[:];
    output Real genes[size(random, 1)] = minimum + (maximum - minimum).*random;
  end uniformSampling;

  function ranking "as linear_ranking(pressure = 2)"
    input Real fitness;
    input Real rank;
    input Real individuals;
    output Real weight = 2 - 2*(rank - 1)/(individuals - 1);
  end ranking;

  function mean "on the line between the parents"
    input Real first[:];
    input Real second[:];
    input Real minimum[:];
    input Real maximum[:];
    input Real random[:,3];
    output Real child1[size(first, 1)];
    output Real child2[size(first, 1)];
  algorithm
    child1 := first + random[1,1]*(second - first);
    child2 := second - random[1,1]*(second - first);
  end mean;

  function draw "as uniform, with the first number of each gene"
    input Real genes[:];
    input Real minimum[:];
    input Real maximum[:];
    input Real rate;
    input Real progress;
    input Real random[:,3];
    output Real mutated[size(genes, 1)];
  algorithm
    for k in 1:size(genes, 1) loop
      mutated[k] := if random[k,1] < rate then minimum[k] + (maximum[k] - minimum[k])*random[k,1]/rate else genes[k];
    end for;
  end draw;

  function best "as mu_plus_lambda, but for equals"
    input Real fitness;
    input Real rank;
    input Real individuals;
    input Real age;
    output Real key = rank;
  end best;

  function offspring "as generational"
    input Real fitness;
    input Real rank;
    input Real individuals;
    input Real age;
    output Real key = if age > 0 then individuals + rank else rank;
  end offspring;

  function far "leaves every range"
    input Real first[:];
    input Real second[:];
    input Real minimum[:];
    input Real maximum[:];
    input Real random[:,3];
    output Real child1[size(first, 1)];
    output Real child2[size(first, 1)];
  algorithm
    child1 := maximum + (maximum - minimum);
    child2 := minimum - (maximum - minimum);
  end far;

  function lost "returns what is no number"
    input Real genes[:];
    input Real minimum[:];
    input Real maximum[:];
    input Real rate;
    input Real progress;
    input Real random[:,3];
    output Real mutated[size(genes, 1)] = sqrt(genes - maximum - random[:,1]);
  end lost;

  function refuses "fails"
    input Real fitness;
    input Real rank;
    input Real individuals;
    output Real weight;
  algorithm
    assert(rank < 3, "the third is too many");
    weight := 1;
  end refuses;
end Own;
