package GAPILib "Parameter identification with genetic algorithms"
  annotation(
    version = "1.0.0",
    Documentation(info = "<html>
<p>The functions of GAPILib as Modelica code: read them, copy them, change them. <code>gapi</code>
has the functions of <a href=\"modelica://GAPILib.Basics\">GAPILib.Basics</a> built in, with the
same results; a function of the same name that a script or a loaded package defines is used
instead of the built-in one.</p>
<p>What the paper leaves open is decided here; those decisions are marked [D].</p>
<h4>Reference</h4>
<p>M. A. Rubio, A. Urquia, L. Gonzalez, D. Guinea, S. Dormido: GAPILib - A Modelica Library for
Model Parameter Identification Using Genetic Algorithms. Proceedings of the 5th International
Modelica Conference, 2006.</p>
</html>"));
end GAPILib;
