within;
package Ordered "first"
  model Zero
    Real x = 0;
  end Zero;
  annotation(version = "1.2.0");
end Ordered;
