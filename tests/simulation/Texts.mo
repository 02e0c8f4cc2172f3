package Texts
  function length
    input String s;
    output Integer n;
    external "C" n = ModelicaStrings_length(s);
  end length;

  function part
    input String s;
    input Integer first;
    input Integer last;
    output String p;
    external "C" p = ModelicaStrings_substring(s, first, last);
  end part;

  function word
    input String s;
    input Integer first;
    output Integer next;
    output String identifier;
    external "C" ModelicaStrings_scanIdentifier(s, first, next, identifier);
  end word;

  function named
    input Integer i;
    input Boolean b;
    output String s;
  algorithm
    s := "n" + String(i) + (if b then "t" else "f");
    for k in 1:i loop
      s := s + String(k);
    end for;
  end named;

  function label
    input Real x;
    output Real y;
  protected
    String s;
  algorithm
    s := String(x, format = ".2f");
    if s == "2.50" then
      y := 10;
    elseif s <> "3.00" then
      y := 20;
    else
      y := 30;
    end if;
  end label;

  model Everything
    discrete Integer k(start = 0, fixed = true);
    discrete String s(start = "none", fixed = true);
    discrete String all(start = "", fixed = true);
    discrete Integer n(start = 0, fixed = true);
    discrete Boolean is_third(start = false, fixed = true);
    discrete Boolean was_none(start = false, fixed = true);
    String sentence = "k is " + String(k) + " and large: " + String(k > 2);
    Integer letters = length(sentence);
    Boolean is_two = sentence == "k is 2 and large: false";
    Boolean begins = part(sentence, 1, 6) == "k is " + String(k);
    Real y = label(time);
    Integer behind;
    String first;
    Boolean is_k = first == "k";
  equation
    (behind, first) = word(sentence, 1);
  algorithm
    when sample(1, 1) then
      k := pre(k) + 1;
      was_none := pre(s) == "none";
      s := named(k, k > 2);
      n := length(s);
      is_third := s == "n3t123";
      all := pre(all) + String(k, minimumLength = 2);
    end when;
    annotation(experiment(StopTime = 4, Interval = 0.5));
  end Everything;
end Texts;
