// A function in a model uses a constant of the model (MLS §5.3.1).
model constant_of_enclosing_model
  model Sun
    constant Real k = 2 * 3;
    function scaled
      input Real u;
      output Real y;
    algorithm
      y := k * u;
    end scaled;
    Real y = scaled(time);
  end Sun;
  Sun sun;
end constant_of_enclosing_model;
