within Broken;
package Deep
  model Good = Broken.Good;
  model Bad
    extends Broken.Bad;
  end Bad;
  package Twins
    model Twin
      Real x = 1;
    end Twin;
    model Twin
      Real x = 2;
    end Twin;
  end Twins;
end Deep;
