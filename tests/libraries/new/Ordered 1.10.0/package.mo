within ;
package Ordered
  model Zero
    Real version = 1;
  end Zero;
  annotation(version = "1.10.0");
end Ordered;
