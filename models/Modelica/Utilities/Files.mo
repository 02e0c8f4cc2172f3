within Modelica.Utilities;
package Files "Files and directories"
  extends Modelica.Icons.FunctionsPackage;

  impure function exist "Whether there is a file or directory"
    extends Modelica.Icons.Function;
    input String name "path";
    output Boolean result "whether there is one";
  algorithm
    result := Internal.FileSystem.stat(name) <> Types.FileType.NoFile;
  end exist;

  impure function assertNew "An error if there is a file or directory already"
    extends Modelica.Icons.Function;
    input String name "path";
    input String message = "This is not allowed." "end of the text of the error";
  algorithm
    if exist(name) then
      Streams.error("\"" + name + "\" exists already. " + message);
    end if;
  end assertNew;

  impure function remove "Removes a file, or a directory with all that is in it"
    extends Modelica.Icons.Function;
    input String name "path; nothing is done if there is nothing of this name";
  protected
    Types.FileType kind = Internal.FileSystem.stat(name) "what it is";
    Integer n = if kind == Types.FileType.Directory then Internal.FileSystem.getNumberOfFiles(name) else 0
      "number of names in the directory";
    String names[n] "names in the directory";
  algorithm
    if kind == Types.FileType.Directory then
      names := Internal.FileSystem.readDirectory(name, n);
      for entry in names loop
        remove(name + "/" + entry);
      end for;
      Internal.FileSystem.rmdir(name);
    elseif kind <> Types.FileType.NoFile then
      Internal.FileSystem.removeFile(name);
    end if;
  end remove;

  impure function removeFile "Removes a file"
    extends Modelica.Icons.Function;
    input String fileName "path; nothing is done if there is nothing of this name";
  protected
    Types.FileType kind = Internal.FileSystem.stat(fileName) "what it is";
  algorithm
    if kind == Types.FileType.RegularFile then
      Internal.FileSystem.removeFile(fileName);
    elseif kind <> Types.FileType.NoFile then
      Streams.error("\"" + fileName + "\" is no file.");
    end if;
  end removeFile;

  impure function copy "Copies a file, or a directory with all that is in it"
    extends Modelica.Icons.Function;
    input String oldName "path";
    input String newName "path of the copy";
    input Boolean replace = false "a file of that path is replaced, else it is an error";
  protected
    Types.FileType kind = Internal.FileSystem.stat(oldName) "what it is";
    Integer n = if kind == Types.FileType.Directory then Internal.FileSystem.getNumberOfFiles(oldName) else 0
      "number of names in the directory";
    String names[n] "names in the directory";
  algorithm
    if kind == Types.FileType.Directory then
      createDirectory(newName);
      names := Internal.FileSystem.readDirectory(oldName, n);
      for entry in names loop
        copy(oldName + "/" + entry, newName + "/" + entry, replace);
      end for;
    elseif kind == Types.FileType.NoFile then
      Streams.error("There is no file or directory \"" + oldName + "\" to be copied.");
    else
      if replace then
        removeFile(newName);
      else
        assertNew(newName, "It would be replaced by a copy.");
      end if;
      Internal.FileSystem.copyFile(oldName, newName);
    end if;
  end copy;

  impure function move "Moves a file or directory"
    extends Modelica.Icons.Function;
    input String oldName "path";
    input String newName "new path";
    input Boolean replace = false "a file of that path is replaced, else it is an error";
  algorithm
    if replace then
      remove(newName);
    else
      assertNew(newName, "It would be replaced by what is moved.");
    end if;
    Internal.FileSystem.rename(oldName, newName);
  end move;

  impure function createDirectory "Makes a directory and those it lies in"
    extends Modelica.Icons.Function;
    input String directoryName "path; nothing is done if there is the directory";
  protected
    String parent "path of the directory that it lies in";
    Types.FileType kind = Internal.FileSystem.stat(directoryName) "what there is";
  algorithm
    if kind == Types.FileType.NoFile then
      (parent,,) := splitPathName(directoryName);
      if parent <> "" and parent <> directoryName and not exist(parent) then
        createDirectory(Strings.substring(parent, 1, max(1, Strings.length(parent) - 1)));
      end if;
      Internal.FileSystem.mkdir(directoryName);
    elseif kind <> Types.FileType.Directory then
      Streams.error("\"" + directoryName + "\" is no directory.");
    end if;
  end createDirectory;

  impure function fullPathName "The full path"
    extends Modelica.Icons.Function;
    input String name "path from the working directory";
    output String fullName "full path";
  external "C" fullName = ModelicaInternal_fullPathName(name);
  end fullPathName;

  function splitPathName "Directory, name and extension of a path"
    extends Modelica.Icons.Function;
    input String pathName "path";
    output String directory "directory with a / at its end; empty if there is none";
    output String name "name without extension";
    output String extension "extension with its dot; empty if there is none";
  protected
    Integer n = Strings.length(pathName) "number of characters";
    Integer slash = Strings.findLast(pathName, "/") "last /";
    Integer dot = Strings.findLast(pathName, ".") "last dot";
  algorithm
    directory := if slash > 0 then Strings.substring(pathName, 1, slash) else "";
    dot := if dot > slash then dot else n + 1;
    name := if dot > slash + 1 then Strings.substring(pathName, slash + 1, dot - 1) else "";
    extension := if dot <= n then Strings.substring(pathName, dot, n) else "";
  end splitPathName;

  impure function temporaryFileName "A path of which there is no file"
    extends Modelica.Icons.Function;
    output String fileName "path";
  external "C" fileName = ModelicaInternal_temporaryFileName();
  end temporaryFileName;

  function loadResource "The path of a file that a URI names"
    extends Modelica.Icons.Function;
    input String uri "URI: modelica://Package/path or file:///path, or a path";
    output String fileReference "full path of the file";
  external "builtin" fileReference = loadResource(uri);
  end loadResource;
end Files;
