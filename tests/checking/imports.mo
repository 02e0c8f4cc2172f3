package imports "imports of what does not exist, or not at the top level"
  package Numbers
    constant Real one = 1;
  end Numbers;

  model Relative
    package Own
      package Inner
        constant Real m = 3;
      end Inner;
    end Own;
    import Own.Inner;
    Real x = Inner.m;
  end Relative;

  model Sibling
    import Numbers.{one, two};
    Real x = one;
  end Sibling;

  model Unused
    import imports.Numbers.three;
    import imports.Number;
    import imports.Numbers;
    Real x = Numbers.one;
  end Unused;
end imports;
