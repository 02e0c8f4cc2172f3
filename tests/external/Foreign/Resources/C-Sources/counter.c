#ifndef COUNTER_C
#define COUNTER_C
#include "counter.h"
#include <stdlib.h>

static int alive = 0;

void *counter_new(int start) {
    int *counter = (int *)malloc(sizeof(int));
    *counter = start;
    alive++;
    return counter;
}

void counter_free(void *counter) {
    alive--;
    free(counter);
}

int counter_next(void *counter) { return ++*(int *)counter; }

int counters_alive(void) { return alive; }

#endif
