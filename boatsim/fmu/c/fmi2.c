/* The functions of FMI 2.0 (Functional Mock-up Interface, https://fmi-standard.org) for one vessel:
   co-simulation. Types and signatures are those of the standard. */
#include "vessel_program.h"

#include "vessel.h"

typedef void *fmi2Component;
typedef unsigned int fmi2ValueReference;
typedef int fmi2Boolean;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum {
    fmi2DoStepStatus,
    fmi2PendingStatus,
    fmi2LastSuccessfulTime,
    fmi2Terminated
} fmi2StatusKind;
typedef struct {
    void (*logger)(void *, const char *, fmi2Status, const char *, const char *, ...);
    void *(*allocate_memory)(size_t, size_t);
    void (*free_memory)(void *);
    void (*step_finished)(void *, fmi2Status);
    void *environment;
} fmi2CallbackFunctions;

#define LONGEST_NAME 200

typedef struct {
    vessel_t vessel;
    char name[LONGEST_NAME];
    fmi2CallbackFunctions functions;
} instance_t;

static fmi2Status report_error(instance_t *self, const char *message) {
    if (self->functions.logger)
        self->functions.logger(
            self->functions.environment, self->name, fmi2Error, "logStatusError", "%s", message);
    return fmi2Error;
}

static fmi2Status not_supported(void *instance, const char *function) {
    char message[LONGEST_MESSAGE];
    snprintf(message, sizeof message, "%s is not supported", function);
    return report_error((instance_t *)instance, message);
}

/* Bring values that follow from others up to date before they are read. */
static const vessel_t *current_vessel(instance_t *self) {
    if (!self->vessel.initialised) initialise(&self->vessel);
    return &self->vessel;
}

/* Life of an instance
   --------------------------------------------------------------------------------------------- */

EXPORTED const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORTED const char *fmi2GetVersion(void) { return "2.0"; }

EXPORTED fmi2Status fmi2SetDebugLogging(
    fmi2Component instance, fmi2Boolean on, size_t count, const char *const categories[]) {
    return fmi2OK; /* errors are always reported, and nothing else is */
}

EXPORTED fmi2Component fmi2Instantiate(
    const char *name, fmi2Type type, const char *guid, const char *resources,
    const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
    const char *refused = NULL;
    if (type != fmi2CoSimulation) refused = "this FMU is for co-simulation";
    if (!guid || strcmp(guid, INSTANTIATION_TOKEN)) refused = "the GUID is not that of this FMU";
    if (refused) {
        if (functions && functions->logger)
            functions->logger(
                functions->environment, name, fmi2Error, "logStatusError", "%s", refused);
        return NULL;
    }
    instance_t *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    if (functions) self->functions = *functions;
    snprintf(self->name, sizeof self->name, "%s", name ? name : "");
    set_start_values(&self->vessel);
    return self;
}

EXPORTED void fmi2FreeInstance(fmi2Component instance) { free(instance); }

EXPORTED fmi2Status fmi2SetupExperiment(
    fmi2Component instance, fmi2Boolean tolerance_defined, double tolerance, double start,
    fmi2Boolean stop_defined, double stop) {
    ((instance_t *)instance)->vessel.time = start;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2EnterInitializationMode(fmi2Component instance) { return fmi2OK; }

EXPORTED fmi2Status fmi2ExitInitializationMode(fmi2Component instance) {
    instance_t *self = instance;
    initialise(&self->vessel);
    self->vessel.initialised = 1;
    if (!is_finite(&self->vessel)) return report_error(self, "the state at the start is not finite");
    return fmi2OK;
}

EXPORTED fmi2Status fmi2Terminate(fmi2Component instance) { return fmi2OK; }

EXPORTED fmi2Status fmi2Reset(fmi2Component instance) {
    set_start_values(&((instance_t *)instance)->vessel);
    return fmi2OK;
}

/* Variables: all are Real
   --------------------------------------------------------------------------------------------- */

EXPORTED fmi2Status fmi2GetReal(
    fmi2Component instance, const fmi2ValueReference *references, size_t count, double *values) {
    instance_t *self = instance;
    const vessel_t *s = current_vessel(self);
    for (size_t i = 0; i < count; i++)
        if (!get_variable(s, references[i], &values[i]))
            return report_error(self, "a value reference does not exist");
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetReal(
    fmi2Component instance, const fmi2ValueReference *references, size_t count,
    const double *values) {
    instance_t *self = instance;
    char message[LONGEST_MESSAGE];
    for (size_t i = 0; i < count; i++)
        if (!set_variable(&self->vessel, references[i], values[i], message))
            return report_error(self, message);
    return fmi2OK;
}

#define NO_VARIABLES(type, name)                                                              \
    EXPORTED fmi2Status fmi2Get##name(                                                        \
        fmi2Component instance, const fmi2ValueReference *references, size_t count,           \
        type *values) {                                                                       \
        return count ? not_supported(instance, "fmi2Get" #name) : fmi2OK;                     \
    }                                                                                         \
    EXPORTED fmi2Status fmi2Set##name(                                                        \
        fmi2Component instance, const fmi2ValueReference *references, size_t count,           \
        const type *values) {                                                                 \
        return count ? not_supported(instance, "fmi2Set" #name) : fmi2OK;                     \
    }
NO_VARIABLES(int, Integer)
NO_VARIABLES(fmi2Boolean, Boolean)
NO_VARIABLES(char *, String)

/* States that are stored
   --------------------------------------------------------------------------------------------- */

EXPORTED fmi2Status fmi2GetFMUstate(fmi2Component instance, void **state) {
    instance_t *self = instance;
    if (!*state) *state = malloc(sizeof(vessel_t));
    if (!*state) return report_error(self, "out of memory");
    memcpy(*state, &self->vessel, sizeof(vessel_t));
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetFMUstate(fmi2Component instance, void *state) {
    memcpy(&((instance_t *)instance)->vessel, state, sizeof(vessel_t));
    return fmi2OK;
}

EXPORTED fmi2Status fmi2FreeFMUstate(fmi2Component instance, void **state) {
    free(*state);
    *state = NULL;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SerializedFMUstateSize(fmi2Component instance, void *state, size_t *size) {
    *size = STORED_SIZE;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SerializeFMUstate(
    fmi2Component instance, void *state, char *bytes, size_t size) {
    if (size < STORED_SIZE) return report_error(instance, "too little memory for a stored state");
    store_state(state, (uint8_t *)bytes);
    return fmi2OK;
}

EXPORTED fmi2Status fmi2DeSerializeFMUstate(
    fmi2Component instance, const char *bytes, size_t size, void **state) {
    vessel_t found;
    if (!read_state(&found, (const uint8_t *)bytes, size))
        return report_error(instance, "the stored state is not one of this FMU");
    if (!*state) *state = malloc(sizeof(vessel_t));
    if (!*state) return report_error(instance, "out of memory");
    memcpy(*state, &found, sizeof found);
    return fmi2OK;
}

/* Co-simulation
   --------------------------------------------------------------------------------------------- */

EXPORTED fmi2Status fmi2DoStep(
    fmi2Component instance, double now, double length, fmi2Boolean no_set_state) {
    instance_t *self = instance;
    vessel_t *s = &self->vessel;
    char message[LONGEST_MESSAGE];
    if (fabs(now - s->time) > SAME_TIME || !(length > 0.0)) {
        snprintf(
            message, sizeof message, "a step of %g s from t = %g s; the vessel is at t = %g s",
            length, now, s->time);
        return report_error(self, message);
    }
    advance(s, length);
    if (!is_finite(s)) {
        snprintf(
            message, sizeof message, "the motion is no longer finite at t = %g s", s->time);
        return report_error(self, message);
    }
    return fmi2OK;
}

EXPORTED fmi2Status fmi2CancelStep(fmi2Component instance) {
    return not_supported(instance, __func__);
}

EXPORTED fmi2Status fmi2GetStatus(
    fmi2Component instance, fmi2StatusKind kind, fmi2Status *value) {
    return not_supported(instance, __func__); /* no step is asynchronous */
}

EXPORTED fmi2Status fmi2GetRealStatus(fmi2Component instance, fmi2StatusKind kind, double *value) {
    if (kind != fmi2LastSuccessfulTime) return not_supported(instance, __func__);
    *value = ((instance_t *)instance)->vessel.time;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2GetIntegerStatus(
    fmi2Component instance, fmi2StatusKind kind, int *value) {
    return not_supported(instance, __func__);
}

EXPORTED fmi2Status fmi2GetBooleanStatus(
    fmi2Component instance, fmi2StatusKind kind, fmi2Boolean *value) {
    if (kind != fmi2Terminated) return not_supported(instance, __func__);
    *value = 0;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2GetStringStatus(
    fmi2Component instance, fmi2StatusKind kind, const char **value) {
    return not_supported(instance, __func__);
}

EXPORTED fmi2Status fmi2SetRealInputDerivatives(
    fmi2Component instance, const fmi2ValueReference *references, size_t count, const int *orders,
    const double *values) {
    return not_supported(instance, __func__);
}

EXPORTED fmi2Status fmi2GetRealOutputDerivatives(
    fmi2Component instance, const fmi2ValueReference *references, size_t count, const int *orders,
    double *values) {
    return not_supported(instance, __func__);
}

EXPORTED fmi2Status fmi2GetDirectionalDerivative(
    fmi2Component instance, const fmi2ValueReference *unknowns, size_t unknown_count,
    const fmi2ValueReference *knowns, size_t known_count, const double *seed,
    double *sensitivity) {
    return not_supported(instance, __func__);
}
