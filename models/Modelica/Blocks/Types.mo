within Modelica.Blocks;
package Types "Choices of blocks, and the tables that lie outside of Modelica"
  extends Modelica.Icons.TypesPackage;

  type Smoothness = enumeration(
    LinearSegments "straight lines between the points",
    ContinuousDerivative "cubic splines of Akima: the derivative is continuous",
    ConstantSegments "the value of the point before",
    MonotoneContinuousDerivative1 "cubic splines of Fritsch and Butland: monotone where the points are",
    MonotoneContinuousDerivative2 "cubic splines of Steffen: monotone where the points are",
    ModifiedContinuousDerivative "cubic splines of Akima, modified against overshoot")
    "What a table gives between its points";

  type Extrapolation = enumeration(
    HoldLastPoint "the first or last value",
    LastTwoPoints "along the line or curve at the end",
    Periodic "the table repeats",
    NoExtrapolation "an error")
    "What a table gives outside of its points";

  type TimeEvents = enumeration(
    Always "at every point",
    AtDiscontinuities "where two points have the same time",
    NoTimeEvents "nowhere")
    "Where a table over time has events";

  type Init = enumeration(
    NoInit "start values are guesses",
    SteadyState "derivatives are zero",
    InitialState "states are given",
    InitialOutput "the output is given")
    "How a block starts";

  type SimpleController = enumeration(
    P "proportional",
    PI "proportional and integral",
    PD "proportional and derivative",
    PID "proportional, integral and derivative")
    "Parts of a controller";

  type AnalogFilter = enumeration(CriticalDamping, Bessel, Butterworth, ChebyshevI) "Families of filters";

  type FilterType = enumeration(LowPass, HighPass, BandPass, BandStop) "What a filter lets pass";

  type Regularization = enumeration(
    Exp "exponential function",
    Sine "sine",
    Linear "straight line",
    Cosine "cosine")
    "How an edge is rounded";

  type LimiterHomotopy = enumeration(
    NoHomotopy "the limits hold from the start",
    Linear "no limits in the simplified problem",
    UpperLimit "the upper limit in the simplified problem",
    LowerLimit "the lower limit in the simplified problem")
    "What a limiter does in the simplified initial problem";

  type VariableLimiterHomotopy = enumeration(
    NoHomotopy "the limits hold from the start",
    Linear "no limits in the simplified problem",
    Fixed "a fixed value in the simplified problem")
    "What a limiter with inputs does in the simplified initial problem";

  class ExternalCombiTimeTable "A table over time"
    extends ExternalObject;

    function constructor "Makes the table"
      extends Modelica.Icons.Function;
      input String tableName "its name in the file";
      input String fileName "file, or \"NoName\"";
      input Real table[:, :] "its points, if it is not in a file";
      input SI.Time startTime "before it the table gives nothing";
      input Integer columns[:] "columns of the outputs";
      input Modelica.Blocks.Types.Smoothness smoothness "between the points";
      input Modelica.Blocks.Types.Extrapolation extrapolation "outside of the points";
      input SI.Time shiftTime = 0.0 "added to the times of the table";
      input Modelica.Blocks.Types.TimeEvents timeEvents = Modelica.Blocks.Types.TimeEvents.Always "where events are";
      input Boolean verboseRead = true "tell that the file is read";
      input String delimiter = "," "between the columns of a CSV file";
      input Integer nHeaderLines = 0 "lines of a CSV file before the points";
      output ExternalCombiTimeTable externalCombiTimeTable "the table";
    external "C" externalCombiTimeTable = ModelicaStandardTables_CombiTimeTable_init3(
      fileName, tableName, table, size(table, 1), size(table, 2), startTime, columns, size(columns, 1),
      smoothness, extrapolation, shiftTime, timeEvents, verboseRead, delimiter, nHeaderLines);
    end constructor;

    function destructor "Gives the table up"
      extends Modelica.Icons.Function;
      input ExternalCombiTimeTable externalCombiTimeTable "the table";
    external "C" ModelicaStandardTables_CombiTimeTable_close(externalCombiTimeTable);
    end destructor;
  end ExternalCombiTimeTable;

  class ExternalCombiTable1D "A table of one variable"
    extends ExternalObject;

    function constructor "Makes the table"
      extends Modelica.Icons.Function;
      input String tableName "its name in the file";
      input String fileName "file, or \"NoName\"";
      input Real table[:, :] "its points, if it is not in a file";
      input Integer columns[:] "columns of the outputs";
      input Modelica.Blocks.Types.Smoothness smoothness "between the points";
      input Modelica.Blocks.Types.Extrapolation extrapolation = Modelica.Blocks.Types.Extrapolation.LastTwoPoints
        "outside of the points";
      input Boolean verboseRead = true "tell that the file is read";
      input String delimiter = "," "between the columns of a CSV file";
      input Integer nHeaderLines = 0 "lines of a CSV file before the points";
      output ExternalCombiTable1D externalCombiTable1D "the table";
    external "C" externalCombiTable1D = ModelicaStandardTables_CombiTable1D_init3(
      fileName, tableName, table, size(table, 1), size(table, 2), columns, size(columns, 1),
      smoothness, extrapolation, verboseRead, delimiter, nHeaderLines);
    end constructor;

    function destructor "Gives the table up"
      extends Modelica.Icons.Function;
      input ExternalCombiTable1D externalCombiTable1D "the table";
    external "C" ModelicaStandardTables_CombiTable1D_close(externalCombiTable1D);
    end destructor;
  end ExternalCombiTable1D;

  class ExternalCombiTable2D "A table of two variables"
    extends ExternalObject;

    function constructor "Makes the table"
      extends Modelica.Icons.Function;
      input String tableName "its name in the file";
      input String fileName "file, or \"NoName\"";
      input Real table[:, :] "its points, if it is not in a file";
      input Modelica.Blocks.Types.Smoothness smoothness "between the points";
      input Modelica.Blocks.Types.Extrapolation extrapolation = Modelica.Blocks.Types.Extrapolation.LastTwoPoints
        "outside of the points";
      input Boolean verboseRead = true "tell that the file is read";
      input String delimiter = "," "between the columns of a CSV file";
      input Integer nHeaderLines = 0 "lines of a CSV file before the points";
      output ExternalCombiTable2D externalCombiTable2D "the table";
    external "C" externalCombiTable2D = ModelicaStandardTables_CombiTable2D_init3(
      fileName, tableName, table, size(table, 1), size(table, 2),
      smoothness, extrapolation, verboseRead, delimiter, nHeaderLines);
    end constructor;

    function destructor "Gives the table up"
      extends Modelica.Icons.Function;
      input ExternalCombiTable2D externalCombiTable2D "the table";
    external "C" ModelicaStandardTables_CombiTable2D_close(externalCombiTable2D);
    end destructor;
  end ExternalCombiTable2D;
end Types;
