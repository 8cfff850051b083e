/* One vessel of a functional mock-up unit (FMU): its numbers, initialisation, steps and outputs.
   vessel_program.h, which is generated, is included before. Units are SI, axes are SNAME. */
#include <stdio.h>
#include <string.h>

#define EXPORTED __attribute__((visibility("default")))
#define LONGEST_MESSAGE 300
#define SAME_LENGTH (1e-6 * STEP) /* [s] rounding of the length of a communication step */
#define SAME_TIME (1e-3 * STEP)   /* [s] rounding of a time that is a sum of very many steps */
#define BODY_NUMBERS 6
#define MOTION_SIGNALS 12
#define INSTRUMENT_READINGS 10
#define FIRST_ACCELERATION 2 /* place of the acceleration along x among the readings */

#if SENSORS
#include "random.h"

#include "sensors.h"
#endif

/* All that changes in a simulation, without pointers, so that it can be copied and stored */
typedef struct {
    double time;             /* [s] */
    double start[2 * NQ];    /* pose and body-axes velocities at the start */
    double inputs[INPUTS];   /* commands and measured signals, as they were set */
    double in_force[INPUTS]; /* the same within the ranges of the commands */
    double external[NQ];     /* external force in body axes */
    double body[BODY_NUMBERS];
    double parameters[PARAMETERS];
    double masses[MASSES];
    double y[2 * NQ]; /* joint coordinates and their rates */
    double memory[MEMORY];
    double act[3 * HELD];   /* actuators at the begin, in the middle and at the end of a part */
    double part_begin;      /* [s] part of a step in which the actuators follow a parabola */
    double part_length;     /* [s] 0 before the first part */
    double part_least;      /* [s] shortest length of the next part */
    double part_before;     /* [s] length of the part before */
    double step_end;        /* [s] end of the step to which the part belongs */
    double before_part[MEMORY]; /* memory at the begin of the part */
    int64_t initialised;    /* whether the initialisation has ended */
#if SENSORS
    sensors_t sensors;
#endif
} vessel_t;

INLINE array1_t array(const double *numbers, int64_t count) {
    return (array1_t){(double *)numbers, count};
}
#define ARRAY(a) array((a), sizeof(a) / sizeof((a)[0]))

static void set_start_values(vessel_t *s) {
    memset(s, 0, sizeof *s);
    memcpy(s->inputs, START_INPUTS, sizeof s->inputs);
    memcpy(s->body, START_BODY, sizeof s->body);
    memcpy(s->parameters, START_PARAMETERS, sizeof s->parameters);
#if SENSORS
    s->sensors.seed = START_SEED;
    memcpy(s->sensors.parameters, START_SENSORS, sizeof s->sensors.parameters);
#endif
}

static void update_masses(vessel_t *s) {
    COMPUTE_MASS_CONSTANTS(
        ARRAY(s->body), ARRAY(s->parameters), ARRAY(SWITCHES), ARRAY(s->masses));
}

static void limit_inputs(vessel_t *s) {
    for (int i = 0; i < INPUTS; i++)
        s->in_force[i] = fmin(fmax(s->inputs[i], INPUT_LOW[i]), INPUT_HIGH[i]);
}

static void settle_actuators(vessel_t *s) {
    limit_inputs(s);
    memset(s->memory, 0, sizeof s->memory);
    SETTLE_ACTUATORS(
        ARRAY(s->in_force), ARRAY(s->memory), ARRAY(s->parameters), ARRAY(SWITCHES), ARRAY(s->act));
}

/* Solve a x = b by Gaussian elimination with pivots; the result replaces b. */
static void solve(double a[NQ][NQ], double *b) {
    for (int i = 0; i < NQ; i++) {
        int pivot = i;
        for (int j = i + 1; j < NQ; j++)
            if (fabs(a[j][i]) > fabs(a[pivot][i])) pivot = j;
        for (int k = 0; k < NQ; k++) {
            double swapped = a[i][k];
            a[i][k] = a[pivot][k];
            a[pivot][k] = swapped;
        }
        double swapped = b[i];
        b[i] = b[pivot];
        b[pivot] = swapped;
        for (int j = i + 1; j < NQ; j++) {
            double factor = a[j][i] / a[i][i];
            for (int k = i; k < NQ; k++) a[j][k] -= factor * a[i][k];
            b[j] -= factor * b[i];
        }
    }
    for (int i = NQ - 1; i >= 0; i--) {
        for (int k = i + 1; k < NQ; k++) b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
}

static void sample_sensors(vessel_t *s);

/* Compute the state from the start values: joint rates from velocities, actuators settled. */
static void initialise(vessel_t *s) {
    double jacobian[6 * NQ] = {0}, rows[NQ][NQ];
    memcpy(s->y, s->start, sizeof s->y);
    JACOBIAN(ARRAY(s->y), (array2_t){jacobian, 6, NQ});
    for (int i = 0; i < NQ; i++)
        for (int k = 0; k < NQ; k++) rows[i][k] = jacobian[FREE_AXES[i] * NQ + k];
    solve(rows, s->y + NQ);
    update_masses(s);
    settle_actuators(s);
    s->part_length = s->part_before = 0.0;
    s->part_least = SHORTEST;
    s->step_end = s->time;
#if SENSORS
    start_sensors(&s->sensors, s->time);
#endif
    sample_sensors(s);
}

static bool is_finite(const vessel_t *s) {
    for (int i = 0; i < 2 * NQ; i++)
        if (!isfinite(s->y[i])) return false;
    return true;
}

/* Co-simulation
   --------------------------------------------------------------------------------------------- */

/* Advance by `length` [s] in steps of STEP; in equal shorter ones if it is no multiple of STEP. */
static void advance(vessel_t *s, double length) {
    int64_t first = 0;
    int64_t steps = llround(length / STEP);
    double dt = STEP;
    if (steps < 1 || fabs(steps * STEP - length) > SAME_LENGTH) {
        steps = (int64_t)ceil(length / STEP);
        dt = length / steps;
    }
    limit_inputs(s);
    fleet_t fleet = {
        array(&s->time, 1),
        {s->y, 1, 2 * NQ},
        {s->in_force, 1, INPUTS},
        {s->memory, 1, MEMORY},
        {s->act, 1, 3 * HELD},
        {s->parameters, 1, PARAMETERS},
        ARRAY(SWITCHES),
        {s->masses, 1, MASSES},
        ARRAY(s->external),
    };
    for (int64_t i = 0; i < steps; i++) {
        ADVANCE_BOATS((rows1_t){&first, 1}, fleet, dt, 1);
        sample_sensors(s);
    }
}

/* Model exchange
   --------------------------------------------------------------------------------------------- */

/* Begin the next part of a step at the present time, in which the inputs are held and no actuator
   has a jump or a kink. It ends with the step of the grid, so that a solver that takes one classical
   Runge-Kutta step for each part gives the numbers of the co-simulation. */
static void begin_part(vessel_t *s) {
    double since = s->time - s->part_begin;
    array1_t p = ARRAY(s->parameters), on = ARRAY(SWITCHES);
    if (s->part_length > 0.0 && since < s->part_length - ENOUGH) {
        /* The part is cut here: the actuators are advanced to this time only. */
        memcpy(s->memory, s->before_part, sizeof s->memory);
        if (since > 0.0)
            ADVANCE_ACTUATORS(ARRAY(s->in_force), ARRAY(s->memory), since, p, on, ARRAY(s->act));
        s->part_before = 0.0;
        s->part_least = SHORTEST;
    } else if (s->part_length > 0.0) {
        s->part_least = MINIMUM_SUBSTEP(s->part_length, s->part_before, s->part_least);
        s->part_before = s->part_length;
    }
    if (s->step_end - s->time <= ENOUGH) {
        s->step_end = s->time + STEP;
        s->part_before = 0.0;
        s->part_least = SHORTEST;
    }
    limit_inputs(s);
    memcpy(s->before_part, s->memory, sizeof s->memory);
    s->part_begin = s->time;
    s->part_length = SUBSTEP_LENGTH(
        ARRAY(s->in_force), ARRAY(s->memory), s->step_end - s->time, s->part_least, p, on);
    ADVANCE_ACTUATORS(ARRAY(s->in_force), ARRAY(s->memory), s->part_length, p, on, ARRAY(s->act));
}

/* Actuators without states follow the inputs at once. */
static void pass_inputs_to_actuators(vessel_t *s) {
    limit_inputs(s);
    ADVANCE_ACTUATORS(
        ARRAY(s->in_force), ARRAY(s->memory), STEP, ARRAY(s->parameters), ARRAY(SWITCHES),
        ARRAY(s->act));
}

/* Actuators now: on the parabola through the three points of the part, or those of the last step. */
static void present_actuators(const vessel_t *s, double *now) {
    double share = 1.0;
    if (s->part_length > 0.0)
        share = fmin(fmax((s->time - s->part_begin) / s->part_length, 0.0), 1.0);
    double begin = (1.0 - share) * (1.0 - 2.0 * share);
    double middle = 4.0 * share * (1.0 - share);
    double end = share * (2.0 * share - 1.0);
    for (int i = 0; i < HELD; i++)
        now[i] = begin * s->act[i] + middle * s->act[HELD + i] + end * s->act[2 * HELD + i];
}

static void state_derivatives(const vessel_t *s, double *derivatives) {
    double now[HELD];
    present_actuators(s, now);
    accelerations_t found = ACCELERATIONS(
        s->time, ARRAY(s->y), ARRAY(now), 0, ARRAY(s->parameters), ARRAY(SWITCHES),
        ARRAY(s->masses), ARRAY(s->external));
    memcpy(derivatives, s->y + NQ, NQ * sizeof(double));
    memcpy(derivatives + NQ, &found, NQ * sizeof(double));
}

/* Take a sample of the sensors, if there are any and one is due. */
static void sample_sensors(vessel_t *s) {
#if SENSORS
    if (s->time < next_sample(&s->sensors) - SAME_TIME) return;
    double now[HELD], readings[INSTRUMENT_READINGS], motion[MOTION_SIGNALS];
    present_actuators(s, now);
    readings_t found = INSTRUMENTS(
        s->time, ARRAY(s->y), ARRAY(now), 0, ARRAY(s->parameters), ARRAY(SWITCHES),
        ARRAY(s->masses), ARRAY(s->external));
    memcpy(readings, &found, sizeof readings);
    motion_t moved = POSE_AND_VELOCITIES(ARRAY(s->y));
    memcpy(motion, &moved, sizeof motion);
    double since = s->time - s->sensors.start, nominal = (double)s->sensors.samples * SAMPLE_PERIOD;
    if (fabs(since - nominal) <= SAME_TIME) since = nominal; /* without rounding errors */
    read_sensors(&s->sensors, readings, motion, since);
#endif
}

/* Variables by value reference
   --------------------------------------------------------------------------------------------- */

static double motion_signal(const vessel_t *s, int i) {
    double signals[MOTION_SIGNALS];
    motion_t found = POSE_AND_VELOCITIES(ARRAY(s->y));
    memcpy(signals, &found, sizeof signals);
    return signals[i];
}

static double body_force(const vessel_t *s, int i) {
    double now[HELD], components[NQ];
    present_actuators(s, now);
    force_t found = TOTAL_BODY_FORCE(
        s->time, ARRAY(s->y), ARRAY(now), 0, ARRAY(s->parameters), ARRAY(SWITCHES));
    memcpy(components, &found, sizeof components);
    return components[i];
}

static double instrument_reading(const vessel_t *s, int i) {
    double now[HELD], readings[INSTRUMENT_READINGS];
    present_actuators(s, now);
    readings_t found = INSTRUMENTS(
        s->time, ARRAY(s->y), ARRAY(now), 0, ARRAY(s->parameters), ARRAY(SWITCHES),
        ARRAY(s->masses), ARRAY(s->external));
    memcpy(readings, &found, sizeof readings);
    return readings[i];
}

static double actuator(const vessel_t *s, int i) {
    double now[HELD];
    present_actuators(s, now);
    return now[i];
}

static double derivative(const vessel_t *s, int i) {
    double derivatives[2 * NQ];
    state_derivatives(s, derivatives);
    return derivatives[i];
}

/* Read a variable; false if the reference does not exist. */
static bool get_variable(const vessel_t *s, uint32_t reference, double *value) {
    if (reference >= VARIABLES) return false;
    int i = VARIABLE[reference].index;
    switch (VARIABLE[reference].kind) {
        case TIME: *value = s->time; break;
        case INPUT: *value = s->inputs[i]; break;
        case EXTERNAL_FORCE: *value = s->external[i]; break;
        case BODY: *value = s->body[i]; break;
        case PARAMETER: *value = s->parameters[i]; break;
        case MOTION: *value = motion_signal(s, SIGNALS[i]); break;
        case ACTUATOR: *value = actuator(s, i); break;
        case FORCE: *value = body_force(s, i); break;
        case READING: *value = instrument_reading(s, FIRST_ACCELERATION + i); break;
        case DERIVATIVE: *value = derivative(s, i); break;
#if SENSORS
        case SENSED: *value = s->sensors.sensed[i]; break;
        case SENSOR_PARAMETER: *value = s->sensors.parameters[i]; break;
        case SEED: *value = s->sensors.seed; break;
#endif
    }
    return true;
}

/* Set a variable; return false and write a message if that is not allowed. */
static bool set_variable(vessel_t *s, uint32_t reference, double value, char *message) {
    if (reference >= VARIABLES) {
        snprintf(message, LONGEST_MESSAGE, "value reference %u does not exist", (unsigned)reference);
        return false;
    }
    int i = VARIABLE[reference].index;
    const char *name = VARIABLE[reference].name;
    double low = VARIABLE[reference].low, high = VARIABLE[reference].high;
    if (!isfinite(value) || value < low || value > high) {
        snprintf(
            message, LONGEST_MESSAGE, "%s = %g; allowed %g to %g", name, value, low, high);
        return false;
    }
    switch (VARIABLE[reference].kind) {
        case INPUT: s->inputs[i] = value; return true;
        case EXTERNAL_FORCE: s->external[i] = value; return true;
        case BODY: s->body[i] = value; update_masses(s); return true;
        case PARAMETER: s->parameters[i] = value; update_masses(s); return true;
        case MOTION:
            if (!s->initialised) {
                s->start[i] = value;
                return true;
            }
            snprintf(message, LONGEST_MESSAGE, "%s can be set before the start only", name);
            return false;
#if SENSORS
        case SEED:
        case SENSOR_PARAMETER:
            if (s->initialised) {
                snprintf(message, LONGEST_MESSAGE, "%s can be set before the start only", name);
                return false;
            }
            if (VARIABLE[reference].kind == SENSOR_PARAMETER) {
                s->sensors.parameters[i] = value;
            } else if (value != floor(value)) {
                snprintf(message, LONGEST_MESSAGE, "%s = %g; allowed are whole numbers", name, value);
                return false;
            } else {
                s->sensors.seed = value;
            }
            return true;
#endif
        default: snprintf(message, LONGEST_MESSAGE, "%s cannot be set", name); return false;
    }
}

/* Stored states
   --------------------------------------------------------------------------------------------- */

#define TOKEN_SIZE sizeof(INSTANTIATION_TOKEN)
#define STORED_SIZE (TOKEN_SIZE + sizeof(vessel_t))

static void store_state(const vessel_t *s, uint8_t *bytes) {
    memcpy(bytes, INSTANTIATION_TOKEN, TOKEN_SIZE);
    memcpy(bytes + TOKEN_SIZE, s, sizeof *s);
}

/* Read a stored state; false if it is not one of this FMU. */
static bool read_state(vessel_t *s, const uint8_t *bytes, size_t size) {
    if (size != STORED_SIZE || memcmp(bytes, INSTANTIATION_TOKEN, TOKEN_SIZE)) return false;
    memcpy(s, bytes + TOKEN_SIZE, sizeof *s);
    return true;
}
