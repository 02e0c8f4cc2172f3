package Foreign "Functions in C beside a library"
  type Level = enumeration(low, middle, high);

  function triple "Scalars"
    input Real x;
    input Integer n;
    output Real y;
    external "C" y = triple(x, n) annotation(Include = "#include \"scalars.c\"");
  end triple;

  function parts "Several outputs by pointer, of all scalar types"
    input Real x;
    input Boolean up;
    input Level level;
    output Integer whole;
    output Real rest;
    output Boolean negative;
    output Level next;
    external "C" parts(x, up, level, whole, rest, negative, next)
      annotation(Include = "#include \"scalars.c\"");
  end parts;

  function transposed "Arrays with their sizes, row-major"
    input Real a[:, :];
    output Real b[size(a, 2), size(a, 1)];
    external "C" transposed(a, size(a, 1), size(a, 2), b)
      annotation(Include = "#include \"arrays.c\"");
  end transposed;

  function weighted "No call written: arrays are followed by their sizes"
    input Real a[:];
    input Integer w[:];
    output Real y;
    external "C" annotation(Include = "#include \"arrays.c\"");
  end weighted;

  function charge "Its annotation is that of the function, its C code forgets a header"
    input String formula;
    output Integer z;
    external "C";
    annotation(Include = "#include \"undeclared.c\"");
  end charge;

  function greeting "Strings in and out"
    input String name;
    output String text;
    external "C" text = greeting(name) annotation(Include = "#include \"strings.c\"");
  end greeting;

  function longest "An array of Strings"
    input String names[:];
    output String text;
    external "C" text = longest(names, size(names, 1))
      annotation(Include = "#include \"strings.c\"");
  end longest;

  function root "Fails for negative arguments"
    input Real x;
    output Real y;
    external "C" y = own_root(x) annotation(Include = "#include \"errors.c\"");
  end root;

  function talk "Says something"
    input Real x;
    output Real y;
    external "C" y = talk(x) annotation(Include = "#include \"errors.c\"");
  end talk;

  function cube "With a derivative"
    input Real x;
    output Real y;
    external "C" y = cube(x) annotation(Include = "#include \"scalars.c\"");
    annotation(derivative = cube_der);
  end cube;

  function cube_der
    input Real x;
    input Real der_x;
    output Real der_y;
    external "C" der_y = cube_der(x, der_x) annotation(Include = "#include \"scalars.c\"");
  end cube_der;

  function missing "Not defined anywhere"
    input Real x;
    output Real y;
    external "C" y = nowhere(x) annotation(Library = "no_such_library");
  end missing;

  function fortran
    input Real x;
    output Real y;
    external "FORTRAN 77" y = f77(x) annotation(Library = "f77");
  end fortran;

  class Counter "An object with a state"
    extends ExternalObject;

    function constructor
      input Integer start;
      output Counter counter;
      external "C" counter = counter_new(start)
        annotation(Include = "#include \"counter.c\"",
          IncludeDirectory = "modelica://Foreign/Resources/C-Sources");
    end constructor;

    function destructor
      input Counter counter;
      external "C" counter_free(counter)
        annotation(Include = "#include \"counter.c\"",
          IncludeDirectory = "modelica://Foreign/Resources/C-Sources");
    end destructor;
  end Counter;

  impure function next
    input Counter counter;
    output Integer n;
    external "C" n = counter_next(counter)
      annotation(Include = "#include \"counter.h\"",
        IncludeDirectory = "modelica://Foreign/Resources/C-Sources");
  end next;

  class Names "An object made of Strings"
    extends ExternalObject;

    function constructor
      input String all[:];
      output Names names;
      external "C" names = names_new(all, size(all, 1))
        annotation(Include = "#include \"names.c\"");
    end constructor;

    function destructor
      input Names names;
      external "C" names_free(names) annotation(Include = "#include \"names.c\"");
    end destructor;
  end Names;

  function name "A String of an object"
    input Names names;
    input Integer at;
    output String text;
    external "C" text = names_get(names, at) annotation(Include = "#include \"names.c\"");
  end name;

  impure function alive "How many counters were not freed yet"
    output Integer n;
    external "C" n = counters_alive()
      annotation(Include = "#include \"counter.h\"",
        IncludeDirectory = "modelica://Foreign/Resources/C-Sources");
  end alive;

  package Examples
    model Scalars "Compiled functions and constant evaluation"
      parameter Real p = triple(2, 3);
      Real x(start = 1, fixed = true);
      Real y = triple(x, 2);
      Integer whole;
      Real rest;
      Boolean negative;
      Level level;
    equation
      der(x) = -triple(x, 0);
      when time > 0.5 then
        (whole, rest, negative, level) = parts(-2.75 + time, true, Level.low);
      end when;
    end Scalars;

    model Arrays
      Real a[2, 3] = {{time, 2, 3}, {4, 5, 6}};
      Real b[3, 2] = transposed(a);
      Real y = weighted(b[:, 1], {1, 10, 100});
    end Arrays;

    model Loop "The derivative is needed: cube(x) = time + 1"
      Real x(start = 1);
      Real v = der(x);
    equation
      cube(x) = time + 1;
    end Loop;

    model Counters "Two objects with equal arguments are two objects"
      Counter a = Counter(10);
      Counter b = Counter(10);
      discrete Integer i(start = 0, fixed = true);
      discrete Integer j(start = 0, fixed = true);
    algorithm
      when sample(0, 0.25) then
        i := next(a);
        if time > 0.4 then
          j := next(b);
        end if;
      end when;
    end Counters;

    model StringsOfObjects
      parameter String all[2] = {"12.5", "4"};
      parameter Names names = Names(all);
      parameter Real second = Modelica.Utilities.Strings.scanReal(name(names, 2));
      parameter String joined = name(names, 1) + "/" + name(names, 2);
      parameter Integer n = Modelica.Utilities.Strings.length(joined);
      Real y = second*time + n;
    end StringsOfObjects;

    model Fails
      Real y = root(0.5 - time);
    end Fails;
  end Examples;
end Foreign;
