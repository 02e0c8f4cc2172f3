/* The functions of ModelicaUtilities.h for one unit. One thread is in a unit at a time. */
#include "ModelicaUtilities.h"
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Where an error leads; 0 outside of calls. */
jmp_buf *gapi_back = 0;

/* The text of the last error. */
static char error_text[4096];

/* What messages and warnings said since the last call. */
static char *log_text = 0;
static size_t log_length = 0;

/* Strings that were allocated since the last call. */
struct string_of_call { struct string_of_call *next; };
static struct string_of_call *strings = 0;

const char *gapi_error(void) { return error_text; }

const char *gapi_log(void) { return log_text ? log_text : ""; }

/* After the results of a call were copied. */
void gapi_release(void) {
    while (strings) {
        struct string_of_call *next = strings->next;
        free(strings);
        strings = next;
    }
    free(log_text);
    log_text = 0;
    log_length = 0;
    error_text[0] = 0;
}

static void add_to_log(const char *text) {
    size_t more = strlen(text);
    /* What is printed without end does not take all memory. */
    if (log_length + more > ((size_t)1 << 24)) return;
    char *longer = (char *)realloc(log_text, log_length + more + 1);
    if (!longer) return;
    memcpy(longer + log_length, text, more + 1);
    log_text = longer;
    log_length += more;
}

static void go_back(void) {
    if (!gapi_back) {
        fprintf(stderr, "ModelicaError outside of a call: %s\n", error_text);
        abort();
    }
    longjmp(*gapi_back, 1);
}

static void log_formatted(const char *before, const char *string, va_list arguments) {
    char text[4096];
    vsnprintf(text, sizeof text, string, arguments);
    add_to_log(before);
    add_to_log(text);
    add_to_log("\n");
}

void ModelicaMessage(const char *string) { add_to_log(string); add_to_log("\n"); }

void ModelicaVFormatMessage(const char *string, va_list arguments) { log_formatted("", string, arguments); }

void ModelicaFormatMessage(const char *string, ...) {
    va_list arguments;
    va_start(arguments, string);
    log_formatted("", string, arguments);
    va_end(arguments);
}

void ModelicaWarning(const char *string) { add_to_log("Warning: "); ModelicaMessage(string); }

void ModelicaVFormatWarning(const char *string, va_list arguments) { log_formatted("Warning: ", string, arguments); }

void ModelicaFormatWarning(const char *string, ...) {
    va_list arguments;
    va_start(arguments, string);
    log_formatted("Warning: ", string, arguments);
    va_end(arguments);
}

void ModelicaError(const char *string) {
    snprintf(error_text, sizeof error_text, "%s", string);
    go_back();
    abort();
}

void ModelicaVFormatError(const char *string, va_list arguments) {
    vsnprintf(error_text, sizeof error_text, string, arguments);
    go_back();
    abort();
}

void ModelicaFormatError(const char *string, ...) {
    va_list arguments;
    va_start(arguments, string);
    vsnprintf(error_text, sizeof error_text, string, arguments);
    va_end(arguments);
    go_back();
    abort();
}

char *ModelicaAllocateStringWithErrorReturn(size_t length) {
    struct string_of_call *head = (struct string_of_call *)calloc(1, sizeof *head + length + 1);
    if (!head) return 0;
    head->next = strings;
    strings = head;
    return (char *)(head + 1);
}

char *ModelicaAllocateString(size_t length) {
    char *string = ModelicaAllocateStringWithErrorReturn(length);
    if (!string) ModelicaError("there is no memory for a string");
    return string;
}

char *ModelicaDuplicateStringWithErrorReturn(const char *string) {
    size_t length = strlen(string);
    char *copy = ModelicaAllocateStringWithErrorReturn(length);
    if (copy) memcpy(copy, string, length + 1);
    return copy;
}

char *ModelicaDuplicateString(const char *string) {
    char *copy = ModelicaDuplicateStringWithErrorReturn(string);
    if (!copy) ModelicaError("there is no memory for a string");
    return copy;
}
