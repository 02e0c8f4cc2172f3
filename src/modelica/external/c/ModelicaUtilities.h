/* What C code of libraries may call (MLS 12.9.6). */
#ifndef MODELICA_UTILITIES_H
#define MODELICA_UTILITIES_H

#include <stdarg.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define MODELICA_NORETURNATTR __attribute__((noreturn))
#define MODELICA_FORMATATTR_PRINTF __attribute__((format(printf, 1, 2)))
#define MODELICA_FORMATATTR_VPRINTF __attribute__((format(printf, 1, 0)))
#else
#define MODELICA_NORETURNATTR
#define MODELICA_FORMATATTR_PRINTF
#define MODELICA_FORMATATTR_VPRINTF
#endif
#define MODELICA_NORETURN

void ModelicaMessage(const char *string);
void ModelicaFormatMessage(const char *string, ...) MODELICA_FORMATATTR_PRINTF;
void ModelicaVFormatMessage(const char *string, va_list arguments) MODELICA_FORMATATTR_VPRINTF;
void ModelicaWarning(const char *string);
void ModelicaFormatWarning(const char *string, ...) MODELICA_FORMATATTR_PRINTF;
void ModelicaVFormatWarning(const char *string, va_list arguments) MODELICA_FORMATATTR_VPRINTF;
void ModelicaError(const char *string) MODELICA_NORETURNATTR;
void ModelicaFormatError(const char *string, ...) MODELICA_NORETURNATTR MODELICA_FORMATATTR_PRINTF;
void ModelicaVFormatError(const char *string, va_list arguments) MODELICA_NORETURNATTR MODELICA_FORMATATTR_VPRINTF;
char *ModelicaAllocateString(size_t length);
char *ModelicaAllocateStringWithErrorReturn(size_t length);
char *ModelicaDuplicateString(const char *string);
char *ModelicaDuplicateStringWithErrorReturn(const char *string);

#ifdef __cplusplus
}
#endif

#endif
