#ifndef UNDECLARED_C
#define UNDECLARED_C

int charge(const char *formula) {
    size_t n = strlen(formula);
    return atoi(formula + (n > 1 ? n - 2 : 0));
}

#endif
