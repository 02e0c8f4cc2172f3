within ;
package Ordered
  model Zero
    Real version = 2;
  end Zero;
  annotation(version = "2.0.0");
end Ordered;
