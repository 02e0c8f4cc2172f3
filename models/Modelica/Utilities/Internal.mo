within Modelica.Utilities;
package Internal "What lies below the functions for files"
  extends Modelica.Icons.InternalPackage;

  package FileSystem "The file system"
    extends Modelica.Icons.Package;

    impure function mkdir "Makes a directory"
      extends Modelica.Icons.Function;
      input String directoryName "its path";
    external "C" ModelicaInternal_mkdir(directoryName);
    end mkdir;

    impure function rmdir "Removes an empty directory"
      extends Modelica.Icons.Function;
      input String directoryName "its path";
    external "C" ModelicaInternal_rmdir(directoryName);
    end rmdir;

    impure function stat "What a path stands for"
      extends Modelica.Icons.Function;
      input String name "path";
      output Types.FileType fileType "what it stands for";
    external "C" fileType = ModelicaInternal_stat(name);
    end stat;

    impure function rename "Gives a file or directory another path"
      extends Modelica.Icons.Function;
      input String oldName "path";
      input String newName "the other path";
    external "C" ModelicaInternal_rename(oldName, newName);
    end rename;

    impure function removeFile "Removes a file"
      extends Modelica.Icons.Function;
      input String fileName "its path";
    external "C" ModelicaInternal_removeFile(fileName);
    end removeFile;

    impure function copyFile "Copies a file"
      extends Modelica.Icons.Function;
      input String fromName "its path";
      input String toName "path of the copy, of which there is no file";
    external "C" ModelicaInternal_copyFile(fromName, toName);
    end copyFile;

    impure function readDirectory "Names in a directory"
      extends Modelica.Icons.Function;
      input String directory "its path";
      input Integer nNames "number of names, as getNumberOfFiles gives it";
      output String names[nNames] "names, in no order";
    external "C" ModelicaInternal_readDirectory(directory, nNames, names);
    end readDirectory;

    impure function getNumberOfFiles "Number of names in a directory"
      extends Modelica.Icons.Function;
      input String directory "its path";
      output Integer result "number";
    external "C" result = ModelicaInternal_getNumberOfFiles(directory);
    end getNumberOfFiles;
  end FileSystem;
end Internal;
