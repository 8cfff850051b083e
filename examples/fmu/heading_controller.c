/* A heading controller for two fixed thrusters as an FMU of FMI 2.0 for co-simulation.
   heading_controller.xml describes its variables. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define EXPORTED __attribute__((visibility("default")))
#define TOKEN "{boatsim-heading-controller}"

enum { HEADING, YAW_RATE, GOAL, GAIN, DAMPING, AHEAD, PORT, STARBOARD, VARIABLES };
typedef struct {
    double value[VARIABLES];
} controller_t;

static const controller_t START = {{
    [GOAL] = 1.0,    /* [rad] */
    [GAIN] = 1.0,    /* [N/rad] */
    [DAMPING] = 2.0, /* [N s/rad] */
    [AHEAD] = 0.5,   /* [N] thrust of each thruster on the right heading */
}};

/* More thrust to port turns the boat clockwise, to a larger heading. */
static void update(controller_t *c) {
    double error = c->value[GOAL] - c->value[HEADING];
    double turn = c->value[GAIN] * error - c->value[DAMPING] * c->value[YAW_RATE];
    c->value[PORT] = c->value[AHEAD] + turn;
    c->value[STARBOARD] = c->value[AHEAD] - turn;
}

EXPORTED const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORTED const char *fmi2GetVersion(void) { return "2.0"; }

EXPORTED void *fmi2Instantiate(
    const char *name, int type, const char *guid, const char *resources, const void *functions,
    int visible, int logging) {
    if (strcmp(guid, TOKEN)) return NULL;
    controller_t *c = malloc(sizeof *c);
    if (c) *c = START;
    return c;
}

EXPORTED void fmi2FreeInstance(void *c) { free(c); }

EXPORTED int fmi2SetupExperiment(
    void *c, int tolerance_defined, double tolerance, double start, int stop_defined,
    double stop) {
    return 0;
}

EXPORTED int fmi2EnterInitializationMode(void *c) { return 0; }

EXPORTED int fmi2ExitInitializationMode(void *c) {
    update(c);
    return 0;
}

EXPORTED int fmi2Terminate(void *c) { return 0; }

EXPORTED int fmi2Reset(void *c) {
    *(controller_t *)c = START;
    return 0;
}

EXPORTED int fmi2GetReal(
    void *c, const unsigned int *references, size_t count, double *values) {
    for (size_t i = 0; i < count; i++) values[i] = ((controller_t *)c)->value[references[i]];
    return 0;
}

EXPORTED int fmi2SetReal(
    void *c, const unsigned int *references, size_t count, const double *values) {
    for (size_t i = 0; i < count; i++) ((controller_t *)c)->value[references[i]] = values[i];
    return 0;
}

EXPORTED int fmi2DoStep(void *c, double now, double length, int no_set_state) {
    update(c);
    return 0;
}

/* Functions of the standard that this controller does not offer return fmi2Error. */
#define NOT_OFFERED(name) \
    EXPORTED int name(void) { return 3; }
NOT_OFFERED(fmi2SetDebugLogging)
NOT_OFFERED(fmi2GetInteger)
NOT_OFFERED(fmi2GetBoolean)
NOT_OFFERED(fmi2GetString)
NOT_OFFERED(fmi2SetInteger)
NOT_OFFERED(fmi2SetBoolean)
NOT_OFFERED(fmi2SetString)
NOT_OFFERED(fmi2GetFMUstate)
NOT_OFFERED(fmi2SetFMUstate)
NOT_OFFERED(fmi2FreeFMUstate)
NOT_OFFERED(fmi2SerializedFMUstateSize)
NOT_OFFERED(fmi2SerializeFMUstate)
NOT_OFFERED(fmi2DeSerializeFMUstate)
NOT_OFFERED(fmi2GetDirectionalDerivative)
NOT_OFFERED(fmi2SetRealInputDerivatives)
NOT_OFFERED(fmi2GetRealOutputDerivatives)
NOT_OFFERED(fmi2CancelStep)
NOT_OFFERED(fmi2GetStatus)
NOT_OFFERED(fmi2GetRealStatus)
NOT_OFFERED(fmi2GetIntegerStatus)
NOT_OFFERED(fmi2GetBooleanStatus)
NOT_OFFERED(fmi2GetStringStatus)
