within Modelica.Utilities;
package Streams "Lines and matrices in files and on the terminal"
  extends Modelica.Icons.FunctionsPackage;

  impure function print "Prints a line"
    extends Modelica.Icons.Function;
    input String string = "" "the line";
    input String fileName = "" "file behind whose end it goes; empty: the terminal";
  external "C" ModelicaInternal_print(string, fileName);
  end print;

  impure function readFile "The lines of a file"
    extends Modelica.Icons.Function;
    input String fileName "file";
    output String stringVector[countLines(fileName)] "lines";
  external "C" ModelicaInternal_readFile(fileName, stringVector, size(stringVector, 1));
  end readFile;

  impure function readLine "A line of a file"
    extends Modelica.Icons.Function;
    input String fileName "file";
    input Integer lineNumber(min = 1) "number of the line";
    output String string "the line";
    output Boolean endOfFile "whether the file has fewer lines";
  external "C" string = ModelicaInternal_readLine(fileName, lineNumber, endOfFile);
  end readLine;

  impure function countLines "Number of lines of a file"
    extends Modelica.Icons.Function;
    input String fileName "file";
    output Integer numberOfLines "number";
  external "C" numberOfLines = ModelicaInternal_countLines(fileName);
  end countLines;

  function error "An error that ends what is being done"
    extends Modelica.Icons.Function;
    input String string "text of the error";
  external "C" ModelicaError(string);
  end error;

  impure function close "Closes a file that was printed to"
    extends Modelica.Icons.Function;
    input String fileName "file";
  external "C" ModelicaStreams_closeFile(fileName);
  end close;

  impure function readMatrixSize "Size of a matrix in a MATLAB file"
    extends Modelica.Icons.Function;
    input String fileName "file";
    input String matrixName "matrix";
    output Integer dim[2] "rows and columns";
  external "C" ModelicaIO_readMatrixSizes(fileName, matrixName, dim);
  end readMatrixSize;

  impure function readRealMatrix "A matrix of a MATLAB file"
    extends Modelica.Icons.Function;
    input String fileName "file";
    input String matrixName "matrix";
    input Integer nrow "number of rows";
    input Integer ncol "number of columns";
    input Boolean verboseRead = true "tell that the file is read";
    output Real matrix[nrow, ncol] "the matrix";
  external "C" ModelicaIO_readRealMatrix(fileName, matrixName, matrix, size(matrix, 1), size(matrix, 2), verboseRead);
  end readRealMatrix;

  impure function writeRealMatrix "Writes a matrix to a MATLAB file"
    extends Modelica.Icons.Function;
    input String fileName "file";
    input String matrixName "name of the matrix in the file";
    input Real matrix[:, :] "the matrix";
    input Boolean append = false "keep what is in the file";
    input String format = "4" "version of the format: 4, 6 or 7";
    output Boolean success "whether it is written";
  external "C" success = ModelicaIO_writeRealMatrix(
    fileName, matrixName, matrix, size(matrix, 1), size(matrix, 2), append, format);
  end writeRealMatrix;
end Streams;
