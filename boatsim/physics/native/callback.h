/* MuJoCo's passive-force callback of one vessel, called for every stage of a step.
   NQ, NM, PARAMETERS_AND_REST and ADD_FORCES are defined before. */
static int64_t of_size, of_time, of_q, of_rates, of_user, of_force, of_mass, size_of_user;
static void (*factor_mass)(const void *, void *);

/* Words: offsets in MuJoCo's structs, floats of userdata, and the address of mj_factorM. */
double boatsim_configure_callback(const word_t *a, double *results) {
    of_size = a[0].whole;
    of_time = a[1].whole;
    of_q = a[2].whole;
    of_rates = a[3].whole;
    of_user = a[4].whole;
    of_force = a[5].whole;
    of_mass = a[6].whole;
    size_of_user = a[7].whole;
    factor_mass = (void (*)(const void *, void *))a[8].at;
    return 0.0;
}

void boatsim_passive_callback(const void *model, void *data) {
    if (((const int32_t *)model)[of_size] != size_of_user) return;
    const word_t *w = (const word_t *)data;
    ADD_FORCES(
        w[of_time].real, (array1_t){w[of_q].at, NQ}, (array1_t){w[of_rates].at, NQ},
        (array1_t){w[of_user].at, size_of_user}, size_of_user - PARAMETERS_AND_REST,
        (array1_t){w[of_force].at, NQ}, (array1_t){w[of_mass].at, NM});
    factor_mass(model, data);
}
