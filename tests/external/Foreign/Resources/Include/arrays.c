#ifndef ARRAYS_C
#define ARRAYS_C
#include <stddef.h>

void transposed(const double *a, size_t rows, size_t columns, double *b) {
    size_t i, j;
    for (i = 0; i < rows; i++)
        for (j = 0; j < columns; j++) b[j * rows + i] = a[i * columns + j];
}

double weighted(const double *a, size_t n, const int *w, size_t m) {
    double sum = 0;
    size_t i;
    for (i = 0; i < n && i < m; i++) sum += a[i] * w[i];
    return sum;
}

#endif
