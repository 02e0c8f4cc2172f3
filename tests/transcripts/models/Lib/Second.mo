within Lib;
function Second "Doubles"
  input Real u;
  input Real factor = gain;
  output Real y;
algorithm
  y := factor*u;
end Second;
