/* The functions of FMI 3.0 (Functional Mock-up Interface, https://fmi-standard.org) for one vessel:
   co-simulation and model exchange. Types and signatures are those of the standard. */
#include "vessel_program.h"

#include "vessel.h"

typedef void *fmi3Instance;
typedef uint32_t fmi3ValueReference;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef void (*fmi3LogMessage)(void *, fmi3Status, const char *, const char *);

typedef struct {
    vessel_t vessel;
    bool model_exchange;
    void *environment;
    fmi3LogMessage log;
} instance_t;

static fmi3Status report_error(instance_t *self, const char *message) {
    if (self->log) self->log(self->environment, fmi3Error, "logStatusError", message);
    return fmi3Error;
}

static fmi3Status not_supported(void *instance, const char *function) {
    char message[LONGEST_MESSAGE];
    snprintf(message, sizeof message, "%s is not supported", function);
    return report_error((instance_t *)instance, message);
}

/* Bring values that follow from others up to date before they are read. */
static const vessel_t *current_vessel(instance_t *self) {
    vessel_t *s = &self->vessel;
    if (!s->initialised) {
        initialise(s);
    } else if (self->model_exchange && !ACTUATORS_HAVE_STATES) {
        pass_inputs_to_actuators(s);
    }
    return s;
}

/* Life of an instance
   --------------------------------------------------------------------------------------------- */

EXPORTED const char *fmi3GetVersion(void) { return "3.0"; }

EXPORTED fmi3Status fmi3SetDebugLogging(
    fmi3Instance instance, bool on, size_t count, const char *const categories[]) {
    return fmi3OK; /* errors are always reported, and nothing else is */
}

static instance_t *create_instance(
    const char *token, bool model_exchange, void *environment, fmi3LogMessage log) {
    if (!token || strcmp(token, INSTANTIATION_TOKEN)) {
        if (log)
            log(environment, fmi3Error, "logStatusError",
                "the instantiation token is not that of this FMU");
        return NULL;
    }
    instance_t *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->model_exchange = model_exchange;
    self->environment = environment;
    self->log = log;
    set_start_values(&self->vessel);
    return self;
}

EXPORTED fmi3Instance fmi3InstantiateCoSimulation(
    const char *name, const char *token, const char *resources, bool visible, bool logging,
    bool event_mode, bool early_return, const fmi3ValueReference *intermediate,
    size_t intermediate_count, void *environment, fmi3LogMessage log, void *intermediate_update) {
    return create_instance(token, false, environment, log);
}

EXPORTED fmi3Instance fmi3InstantiateModelExchange(
    const char *name, const char *token, const char *resources, bool visible, bool logging,
    void *environment, fmi3LogMessage log) {
    return create_instance(token, true, environment, log);
}

EXPORTED fmi3Instance fmi3InstantiateScheduledExecution(
    const char *name, const char *token, const char *resources, bool visible, bool logging,
    void *environment, fmi3LogMessage log, void *update, void *lock, void *unlock) {
    return NULL;
}

EXPORTED void fmi3FreeInstance(fmi3Instance instance) { free(instance); }

EXPORTED fmi3Status fmi3EnterInitializationMode(
    fmi3Instance instance, bool tolerance_defined, double tolerance, double start,
    bool stop_defined, double stop) {
    ((instance_t *)instance)->vessel.time = start;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
    instance_t *self = instance;
    initialise(&self->vessel);
    self->vessel.initialised = 1;
    if (!is_finite(&self->vessel)) return report_error(self, "the state at the start is not finite");
    return fmi3OK;
}

EXPORTED fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance) { return fmi3OK; }
EXPORTED fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance) { return fmi3OK; }
EXPORTED fmi3Status fmi3EnterEventMode(fmi3Instance instance) { return fmi3OK; }
EXPORTED fmi3Status fmi3EnterStepMode(fmi3Instance instance) { return fmi3OK; }
EXPORTED fmi3Status fmi3Terminate(fmi3Instance instance) { return fmi3OK; }

EXPORTED fmi3Status fmi3Reset(fmi3Instance instance) {
    set_start_values(&((instance_t *)instance)->vessel);
    return fmi3OK;
}

/* Variables: all are Float64
   --------------------------------------------------------------------------------------------- */

EXPORTED fmi3Status fmi3GetFloat64(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count, double *values,
    size_t value_count) {
    instance_t *self = instance;
    const vessel_t *s = current_vessel(self);
    if (count != value_count) return report_error(self, "one value is needed for each variable");
    for (size_t i = 0; i < count; i++)
        if (!get_variable(s, references[i], &values[i]))
            return report_error(self, "a value reference does not exist");
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetFloat64(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count,
    const double *values, size_t value_count) {
    instance_t *self = instance;
    char message[LONGEST_MESSAGE];
    if (count != value_count) return report_error(self, "one value is needed for each variable");
    for (size_t i = 0; i < count; i++)
        if (!set_variable(&self->vessel, references[i], values[i], message))
            return report_error(self, message);
    return fmi3OK;
}

#define NO_VARIABLES(type, name)                                                              \
    EXPORTED fmi3Status fmi3Get##name(                                                        \
        fmi3Instance instance, const fmi3ValueReference *references, size_t count,            \
        type *values, size_t value_count) {                                                   \
        return count ? not_supported(instance, "fmi3Get" #name) : fmi3OK;                     \
    }                                                                                         \
    EXPORTED fmi3Status fmi3Set##name(                                                        \
        fmi3Instance instance, const fmi3ValueReference *references, size_t count,            \
        const type *values, size_t value_count) {                                             \
        return count ? not_supported(instance, "fmi3Set" #name) : fmi3OK;                     \
    }
NO_VARIABLES(float, Float32)
NO_VARIABLES(int8_t, Int8)
NO_VARIABLES(uint8_t, UInt8)
NO_VARIABLES(int16_t, Int16)
NO_VARIABLES(uint16_t, UInt16)
NO_VARIABLES(int32_t, Int32)
NO_VARIABLES(uint32_t, UInt32)
NO_VARIABLES(int64_t, Int64)
NO_VARIABLES(uint64_t, UInt64)
NO_VARIABLES(bool, Boolean)
NO_VARIABLES(char *, String)

/* States that are stored
   --------------------------------------------------------------------------------------------- */

EXPORTED fmi3Status fmi3GetFMUState(fmi3Instance instance, void **state) {
    instance_t *self = instance;
    if (!*state) *state = malloc(sizeof(vessel_t));
    if (!*state) return report_error(self, "out of memory");
    memcpy(*state, &self->vessel, sizeof(vessel_t));
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetFMUState(fmi3Instance instance, void *state) {
    memcpy(&((instance_t *)instance)->vessel, state, sizeof(vessel_t));
    return fmi3OK;
}

EXPORTED fmi3Status fmi3FreeFMUState(fmi3Instance instance, void **state) {
    free(*state);
    *state = NULL;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, void *state, size_t *size) {
    *size = STORED_SIZE;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SerializeFMUState(
    fmi3Instance instance, void *state, uint8_t *bytes, size_t size) {
    if (size < STORED_SIZE) return report_error(instance, "too little memory for a stored state");
    store_state(state, bytes);
    return fmi3OK;
}

EXPORTED fmi3Status fmi3DeserializeFMUState(
    fmi3Instance instance, const uint8_t *bytes, size_t size, void **state) {
    vessel_t found;
    if (!read_state(&found, bytes, size))
        return report_error(instance, "the stored state is not one of this FMU");
    if (!*state) *state = malloc(sizeof(vessel_t));
    if (!*state) return report_error(instance, "out of memory");
    memcpy(*state, &found, sizeof found);
    return fmi3OK;
}

/* Co-simulation
   --------------------------------------------------------------------------------------------- */

EXPORTED fmi3Status fmi3DoStep(
    fmi3Instance instance, double now, double length, bool no_set_state, bool *event_needed,
    bool *terminate, bool *early_return, double *last_time) {
    instance_t *self = instance;
    vessel_t *s = &self->vessel;
    char message[LONGEST_MESSAGE];
    *event_needed = *terminate = *early_return = false;
    *last_time = s->time;
    if (fabs(now - s->time) > SAME_TIME || !(length > 0.0)) {
        snprintf(
            message, sizeof message, "a step of %g s from t = %g s; the vessel is at t = %g s",
            length, now, s->time);
        return report_error(self, message);
    }
    advance(s, length);
    *last_time = s->time;
    if (!is_finite(s)) {
        snprintf(
            message, sizeof message, "the motion is no longer finite at t = %g s", s->time);
        return report_error(self, message);
    }
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetOutputDerivatives(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count,
    const int32_t *orders, double *values, size_t value_count) {
    return not_supported(instance, __func__);
}

/* Model exchange: coordinates and their rates are continuous states; actuators advance at events
   --------------------------------------------------------------------------------------------- */

EXPORTED fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance) { return fmi3OK; }

EXPORTED fmi3Status fmi3UpdateDiscreteStates(
    fmi3Instance instance, bool *needs_update, bool *terminate, bool *nominals_changed,
    bool *values_changed, bool *next_defined, double *next_time) {
    instance_t *self = instance;
    vessel_t *s = &self->vessel;
    *needs_update = *terminate = *nominals_changed = *values_changed = *next_defined = false;
    if (!self->model_exchange) return fmi3OK;
    sample_sensors(s);
    *next_time = INFINITY;
    if (ACTUATORS_HAVE_STATES) {
        begin_part(s);
        *next_time = s->part_begin + s->part_length;
    }
#if SENSORS
    *next_time = fmin(*next_time, next_sample(&s->sensors));
#endif
    *next_defined = isfinite(*next_time);
    return fmi3OK;
}

EXPORTED fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance) { return fmi3OK; }

EXPORTED fmi3Status fmi3CompletedIntegratorStep(
    fmi3Instance instance, bool no_set_state, bool *enter_event_mode, bool *terminate) {
    *enter_event_mode = *terminate = false;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetTime(fmi3Instance instance, double time) {
    ((instance_t *)instance)->vessel.time = time;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetContinuousStates(
    fmi3Instance instance, const double *states, size_t count) {
    if (count != 2 * NQ) return report_error(instance, "wrong number of continuous states");
    memcpy(((instance_t *)instance)->vessel.y, states, 2 * NQ * sizeof(double));
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetContinuousStates(fmi3Instance instance, double *states, size_t count) {
    if (count != 2 * NQ) return report_error(instance, "wrong number of continuous states");
    memcpy(states, current_vessel(instance)->y, 2 * NQ * sizeof(double));
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetContinuousStateDerivatives(
    fmi3Instance instance, double *derivatives, size_t count) {
    if (count != 2 * NQ) return report_error(instance, "wrong number of continuous states");
    state_derivatives(current_vessel(instance), derivatives);
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetNominalsOfContinuousStates(
    fmi3Instance instance, double *nominals, size_t count) {
    for (size_t i = 0; i < count; i++) nominals[i] = 1.0;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *count) {
    *count = 2 * NQ;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *count) {
    *count = 0;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetEventIndicators(
    fmi3Instance instance, double *indicators, size_t count) {
    return fmi3OK;
}

/* Parts of the standard that a vessel does not have
   --------------------------------------------------------------------------------------------- */

EXPORTED fmi3Status fmi3GetBinary(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count, size_t *sizes,
    const uint8_t **values, size_t value_count) {
    return count ? not_supported(instance, __func__) : fmi3OK;
}

EXPORTED fmi3Status fmi3SetBinary(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count,
    const size_t *sizes, const uint8_t *const *values, size_t value_count) {
    return count ? not_supported(instance, __func__) : fmi3OK;
}

EXPORTED fmi3Status fmi3GetClock(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count, bool *values) {
    return count ? not_supported(instance, __func__) : fmi3OK;
}

EXPORTED fmi3Status fmi3SetClock(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count,
    const bool *values) {
    return count ? not_supported(instance, __func__) : fmi3OK;
}

EXPORTED fmi3Status fmi3GetNumberOfVariableDependencies(
    fmi3Instance instance, fmi3ValueReference reference, size_t *count) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3GetVariableDependencies(
    fmi3Instance instance, fmi3ValueReference dependent, size_t *dependent_elements,
    fmi3ValueReference *independents, size_t *independent_elements, int *kinds, size_t count) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3GetDirectionalDerivative(
    fmi3Instance instance, const fmi3ValueReference *unknowns, size_t unknown_count,
    const fmi3ValueReference *knowns, size_t known_count, const double *seed, size_t seed_count,
    double *sensitivity, size_t sensitivity_count) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3GetAdjointDerivative(
    fmi3Instance instance, const fmi3ValueReference *unknowns, size_t unknown_count,
    const fmi3ValueReference *knowns, size_t known_count, const double *seed, size_t seed_count,
    double *sensitivity, size_t sensitivity_count) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3GetIntervalDecimal(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count, double *intervals,
    int *qualifiers) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3GetIntervalFraction(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count,
    uint64_t *counters, uint64_t *resolutions, int *qualifiers) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3GetShiftDecimal(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count, double *shifts) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3GetShiftFraction(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count,
    uint64_t *counters, uint64_t *resolutions) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3SetIntervalDecimal(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count,
    const double *intervals) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3SetIntervalFraction(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count,
    const uint64_t *counters, const uint64_t *resolutions) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3SetShiftDecimal(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count,
    const double *shifts) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3SetShiftFraction(
    fmi3Instance instance, const fmi3ValueReference *references, size_t count,
    const uint64_t *counters, const uint64_t *resolutions) {
    return not_supported(instance, __func__);
}

EXPORTED fmi3Status fmi3ActivateModelPartition(
    fmi3Instance instance, fmi3ValueReference clock, double time) {
    return not_supported(instance, __func__);
}
