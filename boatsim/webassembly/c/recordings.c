/* What a page calls to simulate recordings. */

/* Simulate intervals of a recording from given states; see `simulate_intervals` of the kernel. */
EXPORTED("simulate") void simulate(
    int rows, double *times, int changes, double *command_times, double *commands, double max_step,
    double *values, double *switches, int runs, int64_t *starts, int64_t *ends, double *states,
    double *out) {
    inputs_t inputs = {{times, rows}, {command_times, changes}, {commands, changes, INPUTS}};
    vessel_t vessel = {
        {values + VALUES - BODY_NUMBERS, BODY_NUMBERS}, {values, VALUES}, {switches, EFFECTS}};
    SIMULATE_INTERVALS(
        inputs, max_step, vessel, (rows1_t){starts, runs}, (rows1_t){ends, runs},
        (array2_t){states, runs, 2 * NQ}, (array3_t){out, runs, rows, 2 * NQ});
}
