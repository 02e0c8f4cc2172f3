within Modelica.Blocks;
package Tables "Tables of one and two variables"
  extends Modelica.Icons.Package;
  import Modelica.Blocks.Interfaces;

  partial block FromTable "Where the points of a table come from"
    parameter Boolean tableOnFile = false "the table is in a file";
    parameter Real table[:, :] = fill(0.0, 0, 2) "points, if the table is not in a file";
    parameter String tableName = "NoName" "name of the table in the file";
    parameter String fileName = "NoName" "name of the file";
    parameter String delimiter = "," "between the columns of a CSV file";
    parameter Integer nHeaderLines = 0 "lines of a CSV file before the points";
    parameter Boolean verboseRead = true "tell that the file is read";
    parameter Modelica.Blocks.Types.Smoothness smoothness = Modelica.Blocks.Types.Smoothness.LinearSegments
      "between the points";
    parameter Modelica.Blocks.Types.Extrapolation extrapolation = Modelica.Blocks.Types.Extrapolation.LastTwoPoints
      "outside of the points";
    parameter Boolean verboseExtrapolation = false "warn where the input is outside";
  protected
    final parameter String givenFile = if tableOnFile then fileName else "NoName" "file to read";
    final parameter String givenName = if tableOnFile then tableName else "NoName" "table to read";
  end FromTable;

  partial block Table1D "A table of one variable: the first column holds the inputs"
    extends FromTable;
    parameter Integer columns[:] = 2:size(table, 2) "columns of the outputs";
    final parameter Real u_min = Internal.getTable1DAbscissaUmin(tableID) "smallest input of the table";
    final parameter Real u_max = Internal.getTable1DAbscissaUmax(tableID) "greatest input of the table";
  protected
    parameter Modelica.Blocks.Types.ExternalCombiTable1D tableID = Modelica.Blocks.Types.ExternalCombiTable1D(
      givenName, givenFile, table, columns, smoothness, extrapolation, tableOnFile and verboseRead,
      delimiter, nHeaderLines) "the table";
  end Table1D;

  block CombiTable1Ds "Several columns of a table at one input"
    extends Interfaces.SIMO(final nout = size(columns, 1));
    extends Table1D;
  equation
    if verboseExtrapolation then
      assert(u >= u_min and u <= u_max, "the input is outside of the table", AssertionLevel.warning);
    end if;
    if smoothness == Modelica.Blocks.Types.Smoothness.ConstantSegments then
      for i in 1:nout loop
        y[i] = Internal.getTable1DValueNoDer(tableID, i, u);
      end for;
    elseif smoothness == Modelica.Blocks.Types.Smoothness.LinearSegments then
      for i in 1:nout loop
        y[i] = Internal.getTable1DValueNoDer2(tableID, i, u);
      end for;
    else
      for i in 1:nout loop
        y[i] = Internal.getTable1DValue(tableID, i, u);
      end for;
    end if;
  end CombiTable1Ds;

  block CombiTable1Dv "Several columns of a table, each at its own input"
    extends Interfaces.MIMOs(final n = size(columns, 1));
    extends Table1D;
  equation
    if verboseExtrapolation then
      for i in 1:n loop
        assert(u[i] >= u_min and u[i] <= u_max, "an input is outside of the table", AssertionLevel.warning);
      end for;
    end if;
    if smoothness == Modelica.Blocks.Types.Smoothness.ConstantSegments then
      for i in 1:n loop
        y[i] = Internal.getTable1DValueNoDer(tableID, i, u[i]);
      end for;
    elseif smoothness == Modelica.Blocks.Types.Smoothness.LinearSegments then
      for i in 1:n loop
        y[i] = Internal.getTable1DValueNoDer2(tableID, i, u[i]);
      end for;
    else
      for i in 1:n loop
        y[i] = Internal.getTable1DValue(tableID, i, u[i]);
      end for;
    end if;
  end CombiTable1Dv;

  block CombiTable1D = CombiTable1Dv "Name of the block until version 3";

  partial block Table2D
    "A table of two variables: the first column holds the first inputs, the first row the second"
    extends FromTable;
    final parameter Real u_min[2] = Internal.getTable2DAbscissaUmin(tableID) "smallest inputs of the table";
    final parameter Real u_max[2] = Internal.getTable2DAbscissaUmax(tableID) "greatest inputs of the table";
  protected
    parameter Modelica.Blocks.Types.ExternalCombiTable2D tableID = Modelica.Blocks.Types.ExternalCombiTable2D(
      givenName, givenFile, table, smoothness, extrapolation, tableOnFile and verboseRead,
      delimiter, nHeaderLines) "the table";
  end Table2D;

  block CombiTable2Ds "A table at two inputs"
    extends Interfaces.SI2SO;
    extends Table2D;
  equation
    if verboseExtrapolation then
      assert(u1 >= u_min[1] and u1 <= u_max[1] and u2 >= u_min[2] and u2 <= u_max[2],
        "an input is outside of the table", AssertionLevel.warning);
    end if;
    if smoothness == Modelica.Blocks.Types.Smoothness.ConstantSegments then
      y = Internal.getTable2DValueNoDer(tableID, u1, u2);
    elseif smoothness == Modelica.Blocks.Types.Smoothness.LinearSegments then
      y = Internal.getTable2DValueNoDer2(tableID, u1, u2);
    else
      y = Internal.getTable2DValue(tableID, u1, u2);
    end if;
  end CombiTable2Ds;

  block CombiTable2D = CombiTable2Ds "Name of the block until version 3";

  block CombiTable2Dv "A table at vectors of two inputs"
    extends Interfaces.MI2MO;
    extends Table2D;
  equation
    if verboseExtrapolation then
      for i in 1:n loop
        assert(u1[i] >= u_min[1] and u1[i] <= u_max[1] and u2[i] >= u_min[2] and u2[i] <= u_max[2],
          "an input is outside of the table", AssertionLevel.warning);
      end for;
    end if;
    for i in 1:n loop
      if smoothness == Modelica.Blocks.Types.Smoothness.ConstantSegments then
        y[i] = Internal.getTable2DValueNoDer(tableID, u1[i], u2[i]);
      elseif smoothness == Modelica.Blocks.Types.Smoothness.LinearSegments then
        y[i] = Internal.getTable2DValueNoDer2(tableID, u1[i], u2[i]);
      else
        y[i] = Internal.getTable2DValue(tableID, u1[i], u2[i]);
      end if;
    end for;
  end CombiTable2Dv;
  annotation(Documentation(info = "<html>
<p>The points are rows of a matrix: for one variable the input and then the outputs; for two
variables the first row holds the second inputs (its first element means nothing), and each further
row a first input and the outputs. The matrix is a parameter, or lies in a file: a text whose first
line is <code>#1</code> and that holds <code>double name(rows, columns)</code> with the numbers behind
it, a MATLAB file, or a CSV file.</p>
</html>"));
end Tables;
