/* A unit for tests, as FMI 2.0 and as FMI 3.0 (FMI is 2 or 3), for model exchange and co-simulation:

     x' = -k x + u,  x(0) = x0;  at t = 1 x jumps by `jump`;  n counts how often x falls below `threshold`;
     y = (c[1] + ... + c[m]) x;  w = 2 u;  `fault` chooses what goes wrong after t = 0.5.

   `repeats` counts calls for model exchange that set or ask for what was set or asked for before at the point.

   As FMI 2.0 it takes derivatives of u. Its parameter `other` starts with 7, whatever its description says.

   In scheduled execution a tick of `each` makes x (1 - k/10) x and adds 1 to n, one of `trigger` adds u to x
   and 10 to n; a quarter of a second after the third tick of `each`, `wait` ticks and adds 100 to n.

   Only what the standards say of the functions is used; nothing is taken from other sources. */
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT
#endif

enum { X0 = 1, X = 2, DER_X = 3, K = 4, U = 5, Y = 6, JUMP = 7, THRESHOLD = 8, COUNT = 9, FAULT = 10,
       SIZE = 11, C = 12, LABEL = 13, GAIN_ON = 14, W = 15, OTHER = 16, REPEATS = 17, EACH = 21, TRIGGER = 22, WAIT = 23 };
enum { OK = 0, DISCARD = 2, ERROR = 3 };
enum { CRASH = 1, HANG, REPORT, REFUSE, LEAVE, PRINT, NOT_A_NUMBER, WRITE, NO_OUTPUT, END, AWAY, STAY };

typedef struct {
    double t, stop, x0, x, k, u, du, jump, threshold, other, last, c[4];
    int32_t n, fault;
    uint64_t m;
    bool gain_on, jumped, below, is_begun, needs_event, waits;
    bool has_time, has_state, has_derivatives, has_indicators;
    int ticks, repeats;
    char label[64];
    void *environment, *logger;
} Unit;

static void say(Unit *unit, int status, const char *text);

static Unit *made(void) {
    Unit *unit = calloc(1, sizeof(Unit));
    unit->x0 = 1; unit->k = 1; unit->m = 2; unit->other = 7; unit->c[0] = 1; unit->c[1] = 0; unit->gain_on = true;
    unit->threshold = -1e300; unit->stop = 1e300;
    return unit;
}

static double derivative(Unit *unit) {
    if (unit->fault == NOT_A_NUMBER && unit->t > 0.5) return NAN;
    return -unit->k * unit->x + unit->u;
}

/* The unit is at another point, or at none that the importer has set. */
static void moved(Unit *unit) { unit->has_derivatives = unit->has_indicators = false; }
static void set_time(Unit *unit, double t) {
    unit->repeats += unit->has_time && unit->t == t;
    unit->t = t; unit->has_time = true; moved(unit);
}
static void set_state(Unit *unit, double x) {
    unit->repeats += unit->has_state && unit->x == x;
    unit->x = x; unit->has_state = true; moved(unit);
}
static void asked(Unit *unit, bool *before) { unit->repeats += *before; *before = true; }

static double output(Unit *unit) {
    double gain = 0;
    if (unit->fault == NO_OUTPUT && unit->t > 0.5) return NAN;
    for (uint64_t i = 0; i < unit->m; i++) gain += unit->c[i];
    return unit->gain_on ? gain * unit->x : 0;
}

/* What goes wrong at a time. */
static int wrong(Unit *unit) {
    if (unit->t <= 0.5) return OK;
    switch (unit->fault) {
    case CRASH: raise(SIGSEGV); break;
    case HANG: for (;;) { volatile int i = 0; i++; } break;
    case REPORT: say(unit, ERROR, "the pump is dry"); return ERROR;
    case REFUSE: return DISCARD;
    case LEAVE: fprintf(stderr, "last words\n"); fflush(stderr); _Exit(7); break;
    case PRINT: printf("printed to the output"); unit->fault = OK; break;
    case WRITE: { FILE *f = fopen("remaining.txt", "w"); if (f) { fputs("x", f); fclose(f); } break; }
    default: break;
    }
    return OK;
}

static int update(Unit *unit) {
    if (!unit->is_begun) { unit->x = unit->x0; unit->is_begun = true; unit->below = unit->x < unit->threshold; }
    if (!unit->jumped && unit->t >= 1 - 1e-12) { unit->x += unit->jump; unit->jumped = true; }
    bool below = unit->x < unit->threshold;
    if (below && !unit->below) unit->n++;
    unit->below = below;
    unit->has_time = unit->has_state = false;
    moved(unit);
    return OK;
}

/* Co-simulation: the exact solution for an input that is a line. */
static int step(Unit *unit, double t, double h) {
    unit->t = t;
    double end = t + h;
    if (end > unit->stop + 1e-9) { say(unit, ERROR, "the step leads beyond the stop time"); return ERROR; }
    while (unit->t < end - 1e-12 * fabs(end)) {
        double next = !unit->jumped && unit->t < 1 && end >= 1 ? 1 : end, d = next - unit->t;
        double slope = unit->k != 0 ? unit->du / unit->k : 0;
        double rest = unit->k != 0 ? (unit->u - slope) / unit->k : 0;
        unit->x = rest + slope * d + (unit->x - rest) * exp(-unit->k * d);
        unit->u += unit->du * d;
        unit->t = next;
        int status = wrong(unit);
        if (status != OK) return status;
        update(unit);
    }
    unit->last = unit->fault == AWAY ? 99 : unit->t;
    return OK;
}

/* Whether the unit ends the simulation. */
static bool ends_now(Unit *unit) { return unit->t > 0.5 && (unit->fault == END || unit->fault == AWAY); }

static int set_real(Unit *unit, unsigned reference, double value) {
    switch (reference) {
    case X0: unit->x0 = value; return OK;
    case K: unit->k = value; return OK;
    case U: unit->u = value; return OK;
    case JUMP: unit->jump = value; return OK;
    case THRESHOLD: unit->threshold = value; return OK;
    case OTHER: unit->other = value; return OK;
    default: return ERROR;
    }
}

static int get_real(Unit *unit, unsigned reference, double *value) {
    switch (reference) {
    case X0: *value = unit->x0; return OK;
    case X: *value = unit->x; return OK;
    case DER_X: *value = derivative(unit); return OK;
    case K: *value = unit->k; return OK;
    case U: *value = unit->u; return OK;
    case Y: *value = output(unit); return OK;
    case JUMP: *value = unit->jump; return OK;
    case THRESHOLD: *value = unit->threshold; return OK;
    case W: *value = 2 * unit->u; return OK;
    case OTHER: *value = unit->other; return OK;
    case REPEATS: *value = unit->repeats; return OK;
    default: return ERROR;
    }
}

static int initialized(Unit *unit) {
    if (strcmp(unit->label, "refused") == 0) { say(unit, ERROR, "this label is refused"); return ERROR; }
    return update(unit);
}

#if FMI == 2
typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;
typedef struct { int needs_update, terminates, nominals, values, has_next; double next; } EventInfo;

static void say(Unit *unit, int status, const char *text) {
    Callbacks *callbacks = unit->logger;
    callbacks->logger(callbacks->environment, "unit", status, "logStatusError", text);
}
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT void *fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources,
                             const Callbacks *callbacks, int visible, int logging) {
    (void)name; (void)kind; (void)resources; (void)visible; (void)logging;
    if (strcmp(guid, "{unit}") != 0) {
        callbacks->logger(callbacks->environment, "unit", ERROR, "logStatusError", "wrong GUID");
        return NULL;
    }
    Unit *unit = made();
    unit->logger = (void *)callbacks;
    return unit;
}
EXPORT void fmi2FreeInstance(void *unit) { free(unit); }
EXPORT int fmi2SetupExperiment(void *c, int a, double b, double start, int d, double e) {
    (void)a; (void)b; ((Unit *)c)->t = start; if (d) ((Unit *)c)->stop = e; return OK;
}
EXPORT int fmi2EnterInitializationMode(void *c) { (void)c; return OK; }
EXPORT int fmi2ExitInitializationMode(void *c) { return initialized(c); }
EXPORT int fmi2Terminate(void *c) { (void)c; return OK; }
EXPORT int fmi2GetReal(void *c, const unsigned r[], size_t n, double v[]) {
    for (size_t i = 0; i < n; i++) if (get_real(c, r[i], v + i)) return ERROR;
    return OK;
}
EXPORT int fmi2SetReal(void *c, const unsigned r[], size_t n, const double v[]) {
    for (size_t i = 0; i < n; i++) if (set_real(c, r[i], v[i])) return ERROR;
    return OK;
}
EXPORT int fmi2GetInteger(void *c, const unsigned r[], size_t n, int v[]) {
    for (size_t i = 0; i < n; i++) v[i] = r[i] == COUNT ? ((Unit *)c)->n : ((Unit *)c)->fault;
    return OK;
}
EXPORT int fmi2SetInteger(void *c, const unsigned r[], size_t n, const int v[]) {
    for (size_t i = 0; i < n; i++) { if (r[i] != FAULT) return ERROR; ((Unit *)c)->fault = v[i]; }
    return OK;
}
EXPORT int fmi2GetBoolean(void *c, const unsigned r[], size_t n, int v[]) {
    (void)r; for (size_t i = 0; i < n; i++) v[i] = ((Unit *)c)->gain_on; return OK;
}
EXPORT int fmi2SetBoolean(void *c, const unsigned r[], size_t n, const int v[]) {
    (void)r; for (size_t i = 0; i < n; i++) ((Unit *)c)->gain_on = v[i] != 0; return OK;
}
EXPORT int fmi2SetString(void *c, const unsigned r[], size_t n, const char *const v[]) {
    (void)r; for (size_t i = 0; i < n; i++) snprintf(((Unit *)c)->label, 64, "%s", v[i]); return OK;
}
EXPORT int fmi2EnterEventMode(void *c) { (void)c; return OK; }
EXPORT int fmi2NewDiscreteStates(void *c, EventInfo *info) {
    Unit *unit = c;
    update(unit);
    memset(info, 0, sizeof *info);
    info->has_next = !unit->jumped;
    info->next = 1;
    return OK;
}
EXPORT int fmi2EnterContinuousTimeMode(void *c) { (void)c; return OK; }
EXPORT int fmi2CompletedIntegratorStep(void *c, int last, int *event, int *ends) {
    (void)last; *event = 0; *ends = 0; moved(c); return OK;
}
EXPORT int fmi2SetTime(void *c, double t) { set_time(c, t); return wrong(c); }
EXPORT int fmi2SetContinuousStates(void *c, const double x[], size_t n) { (void)n; set_state(c, x[0]); return OK; }
EXPORT int fmi2GetContinuousStates(void *c, double x[], size_t n) { (void)n; x[0] = ((Unit *)c)->x; return OK; }
EXPORT int fmi2GetDerivatives(void *c, double d[], size_t n) {
    (void)n; asked(c, &((Unit *)c)->has_derivatives); d[0] = derivative(c); return OK;
}
EXPORT int fmi2GetEventIndicators(void *c, double z[], size_t n) {
    (void)n; asked(c, &((Unit *)c)->has_indicators); z[0] = ((Unit *)c)->x - ((Unit *)c)->threshold; return OK;
}
EXPORT int fmi2SetRealInputDerivatives(void *c, const unsigned r[], size_t n, const int order[], const double v[]) {
    for (size_t i = 0; i < n; i++) { if (r[i] != U || order[i] != 1) return ERROR; ((Unit *)c)->du = v[i]; }
    return OK;
}
EXPORT int fmi2DoStep(void *c, double t, double h, int set) {
    (void)set;
    int status = step(c, t, h);
    return status == OK && ends_now(c) ? DISCARD : status;
}
EXPORT int fmi2GetBooleanStatus(void *c, int kind, int *value) { (void)kind; *value = ends_now(c); return OK; }
EXPORT int fmi2GetRealStatus(void *c, int kind, double *value) { (void)kind; *value = ((Unit *)c)->last; return OK; }
#else
typedef void (*Logger)(void *, int, const char *, const char *);

static void say(Unit *unit, int status, const char *text) {
    ((Logger)unit->logger)(unit->environment, status, "logStatusError", text);
}
static void *instance(const char *token, void *environment, Logger logger) {
    if (strcmp(token, "{unit}") != 0) {
        logger(environment, ERROR, "logStatusError", "wrong token");
        return NULL;
    }
    Unit *unit = made();
    unit->environment = environment;
    unit->logger = (void *)logger;
    return unit;
}
EXPORT const char *fmi3GetVersion(void) { return "3.0"; }
EXPORT void *fmi3InstantiateModelExchange(const char *name, const char *token, const char *resources,
                                          bool visible, bool logging, void *environment, Logger logger) {
    (void)name; (void)resources; (void)visible; (void)logging;
    return instance(token, environment, logger);
}
EXPORT void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources,
                                         bool visible, bool logging, bool events, bool early,
                                         const uint32_t r[], size_t n, void *environment, Logger logger,
                                         void *update) {
    (void)name; (void)resources; (void)visible; (void)logging; (void)events; (void)early; (void)r; (void)n;
    (void)update;
    return instance(token, environment, logger);
}
EXPORT void fmi3FreeInstance(void *c) { free(c); }
EXPORT int fmi3EnterInitializationMode(void *c, bool a, double b, double start, bool d, double e) {
    (void)a; (void)b; ((Unit *)c)->t = start; if (d) ((Unit *)c)->stop = e; return OK;
}
EXPORT int fmi3ExitInitializationMode(void *c) { return initialized(c); }
EXPORT int fmi3EnterConfigurationMode(void *c) { (void)c; return OK; }
EXPORT int fmi3ExitConfigurationMode(void *c) { (void)c; return OK; }
EXPORT int fmi3Terminate(void *c) { (void)c; return OK; }
EXPORT int fmi3GetFloat64(void *c, const uint32_t r[], size_t n, double v[], size_t nv) {
    (void)nv;
    for (size_t i = 0, at = 0; i < n; i++) {
        Unit *unit = c;
        if (r[i] == C) for (uint64_t k = 0; k < unit->m; k++) v[at++] = unit->c[k];
        else if (get_real(c, r[i], v + at++)) return ERROR;
    }
    return OK;
}
EXPORT int fmi3SetFloat64(void *c, const uint32_t r[], size_t n, const double v[], size_t nv) {
    (void)nv;
    for (size_t i = 0, at = 0; i < n; i++) {
        Unit *unit = c;
        if (r[i] == C) for (uint64_t k = 0; k < unit->m; k++) unit->c[k] = v[at++];
        else if (set_real(c, r[i], v[at++])) return ERROR;
    }
    return OK;
}
EXPORT int fmi3GetInt32(void *c, const uint32_t r[], size_t n, int32_t v[], size_t nv) {
    (void)nv; for (size_t i = 0; i < n; i++) v[i] = r[i] == COUNT ? ((Unit *)c)->n : ((Unit *)c)->fault; return OK;
}
EXPORT int fmi3SetInt32(void *c, const uint32_t r[], size_t n, const int32_t v[], size_t nv) {
    (void)nv;
    for (size_t i = 0; i < n; i++) { if (r[i] != FAULT) return ERROR; ((Unit *)c)->fault = v[i]; }
    return OK;
}
EXPORT int fmi3SetUInt64(void *c, const uint32_t r[], size_t n, const uint64_t v[], size_t nv) {
    (void)nv;
    for (size_t i = 0; i < n; i++) { if (r[i] != SIZE || v[i] > 4) return ERROR; ((Unit *)c)->m = v[i]; }
    return OK;
}
EXPORT int fmi3GetBoolean(void *c, const uint32_t r[], size_t n, bool v[], size_t nv) {
    (void)r; (void)nv; for (size_t i = 0; i < n; i++) v[i] = ((Unit *)c)->gain_on; return OK;
}
EXPORT int fmi3SetBoolean(void *c, const uint32_t r[], size_t n, const bool v[], size_t nv) {
    (void)r; (void)nv; for (size_t i = 0; i < n; i++) ((Unit *)c)->gain_on = v[i]; return OK;
}
EXPORT int fmi3SetString(void *c, const uint32_t r[], size_t n, const char *const v[], size_t nv) {
    (void)r; (void)nv; for (size_t i = 0; i < n; i++) snprintf(((Unit *)c)->label, 64, "%s", v[i]); return OK;
}
EXPORT int fmi3EnterEventMode(void *c) { (void)c; return OK; }
EXPORT int fmi3UpdateDiscreteStates(void *c, bool *again, bool *ends, bool *nominals, bool *values,
                                    bool *has_next, double *next) {
    Unit *unit = c;
    update(unit);
    *again = *ends = *nominals = *values = false;
    *has_next = !unit->jumped;
    *next = 1;
    return OK;
}
EXPORT int fmi3EnterContinuousTimeMode(void *c) { (void)c; return OK; }
EXPORT int fmi3EnterStepMode(void *c) { (void)c; return OK; }
EXPORT int fmi3CompletedIntegratorStep(void *c, bool last, bool *event, bool *ends) {
    (void)last; *event = false; *ends = ends_now(c); moved(c); return OK;
}
EXPORT int fmi3SetTime(void *c, double t) { set_time(c, t); return wrong(c); }
EXPORT int fmi3SetContinuousStates(void *c, const double x[], size_t n) { (void)n; set_state(c, x[0]); return OK; }
EXPORT int fmi3GetContinuousStates(void *c, double x[], size_t n) { (void)n; x[0] = ((Unit *)c)->x; return OK; }
EXPORT int fmi3GetContinuousStateDerivatives(void *c, double d[], size_t n) {
    (void)n; asked(c, &((Unit *)c)->has_derivatives); d[0] = derivative(c); return OK;
}
EXPORT int fmi3GetEventIndicators(void *c, double z[], size_t n) {
    (void)n; asked(c, &((Unit *)c)->has_indicators); z[0] = ((Unit *)c)->x - ((Unit *)c)->threshold; return OK;
}
EXPORT int fmi3GetNumberOfContinuousStates(void *c, size_t *n) { (void)c; *n = 1; return OK; }
EXPORT int fmi3GetNumberOfEventIndicators(void *c, size_t *n) { (void)c; *n = 1; return OK; }
EXPORT void *fmi3InstantiateScheduledExecution(const char *name, const char *token, const char *resources,
                                               bool visible, bool logging, void *environment, Logger logger,
                                               void *clock, void *lock, void *unlock) {
    (void)name; (void)resources; (void)visible; (void)logging; (void)clock; (void)lock; (void)unlock;
    return instance(token, environment, logger);
}
EXPORT int fmi3ActivateModelPartition(void *c, uint32_t clock, double t) {
    Unit *unit = c;
    unit->t = t;
    switch (clock) {
    case EACH:
        unit->x *= 1 - unit->k / 10;
        unit->n += 1;
        unit->waits = ++unit->ticks == 3;
        return OK;
    case TRIGGER: unit->x += unit->u; unit->n += 10; return OK;
    case WAIT: unit->n += 100; return OK;
    default: return ERROR;
    }
}
EXPORT int fmi3GetIntervalDecimal(void *c, const uint32_t r[], size_t n, double v[], int q[]) {
    Unit *unit = c;
    for (size_t i = 0; i < n; i++) {
        q[i] = r[i] == WAIT && unit->waits ? 2 : 1;
        v[i] = 0.25;
        if (q[i] == 2) unit->waits = false;
    }
    return OK;
}
EXPORT int fmi3DoStep(void *c, double t, double h, bool set, bool *event, bool *ends, bool *early, double *last) {
    (void)set;
    *event = false;
    if (((Unit *)c)->fault == STAY && t > 0.45) { *ends = false; *early = true; *last = t; return OK; }
    int status = step(c, t, h);
    *ends = *early = ends_now(c);
    *last = ((Unit *)c)->last;
    return status;
}
#endif
