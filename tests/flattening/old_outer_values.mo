// Before Modelica 3, `outer` components had values, which nothing used: one warning for the
// library, and the value is that of the inner component (FuelCellLib halves a thickness so).
package old_outer_values
  model HalfLayer
    outer parameter Real da = da/2;
    outer parameter Real pH2 = 100000;
    Real width = da;
    Real pressure = pH2;
  end HalfLayer;
  model Layer
    outer parameter Real da;
    HalfLayer half;
    Real width = da;
  end Layer;
  model Main
    inner parameter Real da = 0.25;
    inner parameter Real pH2 = 2e5;
    Layer layer(da = 7);
  end Main;
end old_outer_values;
