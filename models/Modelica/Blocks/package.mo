within Modelica;
package Blocks "Blocks with inputs and outputs"
  extends Modelica.Icons.Package;
  import Modelica.Units.SI;
  annotation(Documentation(info = "<html>
<p>Sources of signals, transfer functions, arithmetic, logic and tables. Outputs are connected to
inputs; the blocks are in sub-packages by what they do.</p>
</html>"));
end Blocks;
