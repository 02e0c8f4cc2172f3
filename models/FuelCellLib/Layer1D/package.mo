within FuelCellLib;
package Layer1D "Layers of a cell"
  annotation(Documentation(info = "<html>
<p>A layer holds the parameters of its elements as <code>inner</code> parameters; it has a face on each
side, at which layers are joined.</p>
</html>"));
end Layer1D;
