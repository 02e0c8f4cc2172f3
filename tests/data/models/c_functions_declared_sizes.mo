package Sizes
  function three input Real u[3]; output Real y; external "C" y = three(u) annotation(Include =
    "static double three(double *u) { return u[0] + u[1] + u[2]; }"); end three;
  function first input Integer n; input Real u[n]; output Real y; external "C" y = first(n, u)
    annotation(Include = "static double first(int n, double *u) { double s = 0; int i;
    for (i = 0; i < n; i++) s += u[i]; return s; }"); end first;
  function lengths input String s[2]; output Integer y; external "C" y = lengths(s) annotation(
    Include = "#include <string.h>
static int lengths(const char **s) {
    return (int)(strlen(s[0]) + strlen(s[1])); }"); end lengths;
  record Pair Real a[2]; end Pair;
  record Row Integer n; Real a[n]; end Row;
  function pair input Pair r; output Real y; external "C" y = pair(r.a) annotation(Include =
    "static double pair(double *a) { return a[0] + a[1]; }"); end pair;
  function row input Row r; output Real y; external "C" y = row(r.n, r.a) annotation(Include =
    "static double row(int n, double *a) { return n > 1 ? a[n - 1] : a[0]; }"); end row;
  function all_rows input Row r[2]; output Real y; external "C" y = all_rows(r) annotation(Include =
    "static double all_rows(double *a) { return a[0]; }"); end all_rows;
  function in_rows input Row r[2]; output Real y; external "C" y = in_rows(r.a) annotation(Include =
    "static double in_rows(double *a) { return a[3]; }"); end in_rows;
  function one_row input Row r[2]; output Real y; external "C" y = one_row(r[1].a) annotation(Include =
    "static double one_row(double *a) { return a[1]; }"); end one_row;
  function each_row input Row r[:]; output Real y;
    algorithm y := sum(i*row(r[i]) for i in 1:size(r, 1)); end each_row;
  function open_output input Real u; output Real y[:]; external "C" fill(u, y) annotation(Include =
    "static void fill(double u, double *y) { int i; for (i = 0; i < 9999; i++) y[i] = u; }");
    end open_output;
  function open_local input Real u; output Real y; protected Real w[:]; external "C" y = work(u, w)
    annotation(Include = "static double work(double u, double *w) { int i;
    for (i = 0; i < 9999; i++) w[i] = u; return w[0]; }"); end open_local;
  class Small extends ExternalObject;
    function constructor input Real x; output Small o; external "C" o = small(x) annotation(
      Include = "#include <stdlib.h>
static void *small(double x) { double *p = malloc(8); *p = x; return p; }");
      end constructor;
    function destructor input Small o; external "C" small_free(o) annotation(
      Include = "#include <stdlib.h>
static void small_free(void *o) { free(o); }"); end destructor;
  end Small;
  class Large extends ExternalObject;
    function constructor input Real x; output Large o; external "C" o = large(x) annotation(
      Include = "#include <stdlib.h>
static void *large(double x) { double *p = calloc(1 << 20, 8); p[1 << 19] = x; return p; }");
      end constructor;
    function destructor input Large o; external "C" large_free(o) annotation(
      Include = "#include <stdlib.h>
static void large_free(void *o) { free(o); }"); end destructor;
  end Large;
  function of_large input Large o; output Real y; external "C" y = of_large(o) annotation(
    Include = "static double of_large(void *o) { return ((double *)o)[1 << 19]; }"); end of_large;
end Sizes;
