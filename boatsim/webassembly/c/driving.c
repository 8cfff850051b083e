/* What a page calls to drive a vessel, which is one boat of a fleet; see `Stepper` and `rollout`. */

static fleet_t boat;

/* Use these arrays: time, state, commands, memory and signals of the actuators, parameters, switches,
   masses, and a further force. */
EXPORTED("place_boat") void place_boat(
    double *t, double *y, double *commands, double *memory, double *act, double *p, double *on,
    double *k, double *force) {
    boat = (fleet_t){{t, 1}, {y, 1, 2 * NQ}, {commands, 1, INPUTS}, {memory, 1, MEMORY},
                     {act, 1, 3 * HELD}, {p, 1, VALUES}, {on, EFFECTS}, {k, 1, MASSES}, {force, NQ}};
}

/* Advance the boat by one step of dt [s], cut where the signal of an actuator has a jump or a kink,
   with the mean (ACTUATORS,) of each actuator over the step. */
EXPORTED("advance") void advance(double dt, double *mean) {
    array1_t y = row_of2(boat.f_y, 0), commands = row_of2(boat.f_commands, 0);
    array1_t memory = row_of2(boat.f_memory, 0), act = row_of2(boat.f_act, 0);
    array1_t p = row_of2(boat.f_p, 0), on = boat.f_on, k = row_of2(boat.f_k, 0);
    double left = dt, least = SHORTEST, before = 0.0;
    for (int i = 0; i < ACTUATORS; i++) mean[i] = 0.0;
    while (left > ENOUGH) {
        double t = boat.f_t.d[0], part = SUBSTEP_LENGTH(commands, memory, left, least, p, on);
        least = MINIMUM_SUBSTEP(part, before, least);
        before = part;
        ADVANCE_ACTUATORS(commands, memory, part, p, on, act);
        ADVANCE_MEMORY_OF_MOTION(t, y, part, memory, act, p, on);
        STEP_IN_PLACE(t, y, part, act, p, on, k, boat.f_force);
        for (int i = 0; i < ACTUATORS; i++)
            mean[i] += (act.d[i] + 4.0 * act.d[HELD + i] + act.d[2 * HELD + i]) / 6.0 * (part / dt);
        boat.f_t.d[0] = t + part;
        left -= part;
    }
}

#ifdef WIND_FORCE
/* The effects of air alone, as a second program: signals, parameters and switches. */
static array1_t wind_act, wind_p, wind_on;

EXPORTED("place_wind") void place_wind(double *act, double *p, double *on) {
    wind_act = (array1_t){act, 3 * WIND_HELD};
    wind_p = (array1_t){p, WIND_VALUES};
    wind_on = (array1_t){on, WIND_EFFECTS};
}
#endif

/* Write the motion of the boat (as `MeasuredMotion`), the sum of all forces on it (NQ,), and the sum
   of those of the air (NQ,) if there are any, to `out`. */
EXPORTED("observe") void observe(double *out) {
    array1_t y = row_of2(boat.f_y, 0);
    state_t state;
    memcpy(&state, y.d, sizeof state);
    motion_t motion = POSE_AND_VELOCITIES(state);
    force_t force = TOTAL_BODY_FORCE(
        boat.f_t.d[0], y, row_of2(boat.f_act, 0), 2 * HELD, row_of2(boat.f_p, 0), boat.f_on);
    memcpy(out, &motion, sizeof motion);
    memcpy(out + sizeof motion / sizeof(double), &force, sizeof force);
#ifdef WIND_FORCE
    force = WIND_FORCE(boat.f_t.d[0], y, wind_act, 2 * WIND_HELD, wind_p, wind_on);
    memcpy(out + sizeof motion / sizeof(double) + NQ, &force, sizeof force);
#endif
}
