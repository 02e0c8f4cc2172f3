#ifndef NAMES_C
#define NAMES_C
#include "ModelicaUtilities.h"
#include <stdlib.h>
#include <string.h>

typedef struct {
    size_t n;
    char **all;
} Names;

void *names_new(const char **all, size_t n) {
    Names *names = malloc(sizeof *names);
    size_t i;
    names->n = n;
    names->all = malloc(n * sizeof *names->all);
    for (i = 0; i < n; i++) {
        names->all[i] = malloc(strlen(all[i]) + 1);
        strcpy(names->all[i], all[i]);
    }
    ModelicaFormatMessage("%d names", (int)n);
    return names;
}

void names_free(void *object) {
    Names *names = object;
    size_t i;
    for (i = 0; i < names->n; i++) free(names->all[i]);
    free(names->all);
    free(names);
}

const char *names_get(void *object, int at) {
    Names *names = object;
    char *text;
    if (at < 1 || (size_t)at > names->n) ModelicaFormatError("there is no name %d", at);
    text = ModelicaAllocateString(strlen(names->all[at - 1]));
    strcpy(text, names->all[at - 1]);
    return text;
}

#endif
