within Modelica.Utilities;
package System "The operating system"
  extends Modelica.Icons.FunctionsPackage;

  impure function getWorkDirectory "The working directory"
    extends Modelica.Icons.Function;
    output String directory "its full path";
  external "C" directory = ModelicaInternal_getcwd(0);
  end getWorkDirectory;

  impure function setWorkDirectory "Changes the working directory"
    extends Modelica.Icons.Function;
    input String directory "its path";
  external "C" ModelicaInternal_chdir(directory);
  end setWorkDirectory;

  impure function getEnvironmentVariable "An environment variable"
    extends Modelica.Icons.Function;
    input String name "its name";
    input Boolean convertToSlash = false "give / for the separators of the system";
    output String content "its value; empty if there is none";
    output Boolean exist "whether there is one";
  external "C" ModelicaInternal_getenv(name, convertToSlash, content, exist);
  end getEnvironmentVariable;

  impure function setEnvironmentVariable "Sets an environment variable"
    extends Modelica.Icons.Function;
    input String name "its name";
    input String content "its value";
    input Boolean convertFromSlash = false "set the separators of the system for /";
  external "C" ModelicaInternal_setenv(name, content, convertFromSlash);
  end setEnvironmentVariable;

  impure function getTime "Date and time of the clock"
    extends Modelica.Icons.Function;
    output Integer ms "milliseconds";
    output Integer sec "seconds";
    output Integer min "minutes";
    output Integer hour "hours";
    output Integer day "day of the month";
    output Integer mon "month";
    output Integer year "year";
  external "C" ModelicaInternal_getTime(ms, sec, min, hour, day, mon, year);
  end getTime;

  impure function getPid "Number of the process"
    extends Modelica.Icons.Function;
    output Integer pid "number";
  external "C" pid = ModelicaInternal_getpid();
  end getPid;

  impure function command "Runs a command of the system"
    extends Modelica.Icons.Function;
    input String string "command";
    output Integer result "its exit code";
  external "C" result = system(string);
  end command;

  impure function exit "Ends the program"
    extends Modelica.Icons.Function;
    input Integer status = 0 "exit code";
  external "C" exit(status);
  end exit;
end System;
