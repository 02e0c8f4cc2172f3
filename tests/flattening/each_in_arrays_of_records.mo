package each_in_arrays_of_records
  record Material
    parameter Real k = 1;
    parameter Real v[2] = {0, 0};
  end Material;
  record Layers
    parameter Integer n = 1;
    parameter Material material[n];
  end Layers;
  model Slab
    parameter Layers layers;
    Real q = sum(layers.material.k);
  end Slab;
  model Main
    Slab different[2](each layers(n = 2, material = {Material(k = 1), Material(k = 2)}));
    Slab same[2](each layers(n = 2, each material(k = 5, v = {3, 4})));
  end Main;
end each_in_arrays_of_records;
