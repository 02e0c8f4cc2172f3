// MLS §5.3.2: nothing is taken from a partial package, but a class in it may be a base, as
// version 4.0.0 of the standard library does.
package base_in_partial_package
  partial package Services
    model Shape
      parameter Real size = 1;
    end Shape;
    constant Real none = 0;
  end Services;
  model Cube
    extends Services.Shape;
    Real volume = size^3;
  end Cube;
  model Main
    Cube cube(size = 2);
  end Main;
end base_in_partial_package;
