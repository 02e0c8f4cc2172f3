#ifndef SCALARS_C
#define SCALARS_C
#include <math.h>

double triple(double x, int n) { return 3 * x + n; }

void parts(double x, int up, int level, int *whole, double *rest, int *negative, int *next) {
    double integral;
    *rest = modf(x, &integral);
    *whole = (int)integral;
    *negative = x < 0;
    *next = up ? level + 1 : level;
}

double cube(double x) { return x * x * x; }

double cube_der(double x, double der_x) { return 3 * x * x * der_x; }

#endif
