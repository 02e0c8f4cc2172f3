#ifndef ERRORS_C
#define ERRORS_C
#include "ModelicaUtilities.h"
#include <math.h>

double own_root(double x) {
    if (x < 0) ModelicaFormatError("%g has no real root", x);
    return sqrt(x);
}

double talk(double x) {
    ModelicaFormatMessage("x is %g", x);
    ModelicaWarning("this is the end");
    return x;
}

#endif
