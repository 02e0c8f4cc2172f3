within FuelCellLib;
package casestudies "Cells with a resistance as their load"
  annotation(Documentation(info = "<html>
<p>The two cells of FuelCellLib 1.0.</p>
</html>"));
end casestudies;
