#ifndef STRINGS_C
#define STRINGS_C
#include "ModelicaUtilities.h"
#include <string.h>

const char *greeting(const char *name) {
    char *text = ModelicaAllocateString(strlen(name) + 7);
    strcpy(text, "Hello, ");
    strcat(text, name);
    return text;
}

const char *longest(const char **names, size_t n) {
    const char *found = "";
    size_t i;
    for (i = 0; i < n; i++)
        if (strlen(names[i]) > strlen(found)) found = names[i];
    return found;
}

#endif
