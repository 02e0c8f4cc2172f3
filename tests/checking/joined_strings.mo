package joined_strings "what is joined with Strings, and Strings in arithmetic"
  operator record Money
    Real amount;
    operator function '+'
      input Money a;
      input String b;
      output Money c = a;
    end '+';
  end Money;

  model Joined
    parameter String unit = "m";
    Integer n = 2;
    Boolean b = true;
    String s = "x = " + n;
    String t = 1.5 + unit;
    String u = unit + b;
    String v = "a" + "b" + 1;
    String w[2] = {"a", "b"} .+ {1, 2};
    String right = "x = " + String(n) + unit;
    Money m = Money(1) + "more";
  end Joined;

  model Arithmetic
    parameter String unit = "m";
    Real x = unit*2;
    Real y = 2 - "a";
    Real z = 1/unit;
    String s = "a" - "b";
  end Arithmetic;
end joined_strings;
