within;
package Broken
  model Good
    Real x = time;
  end Good;
  model Bad
    Real x
  end Bad;
end Broken;
