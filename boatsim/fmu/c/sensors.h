/* Sensors of a vessel with the errors, rates and delays of `boatsim/simulate/sensing.py` and
   `boatsim/simulate/sensors/`. vessel_program.h defines which ones there are (HAS_...), the places
   of their parameters (SENSOR_...) and the numbers of their random streams (STREAM_...).
   One sample of all sensors is taken per SAMPLE_PERIOD, at the end of an integration step. The
   times t of the sensors count from the start of the simulation, which may be at any time. */

#define PI 0x1.921fb54442d18p+1
#define STANDARD_NOISES 7
#define SAMPLE_EXACT 1e-9 /* of a sample: times are sums of floating-point numbers */

/* Readings, in the order of the fields of `Sense` after t, then those of further sensors */
enum { S_PSI, S_R, S_AX, S_AY, S_U, S_V, S_X, S_Y, S_PHI, S_P, S_Q, S_AZ, S_AGE, SENSED_READINGS };
/* Motion: the fields of `MeasuredMotion` */
enum { M_X, M_Y, M_Z, M_PHI, M_THETA, M_PSI, M_U, M_V, M_W, M_P, M_Q, M_R, MOTION_NUMBERS };

/* Alternating times with and without readings */
typedef struct {
    generator_t errors;
    double next; /* [s] end of the present time */
    int64_t out;
} outages_t;

typedef struct {
    double seed;
    double parameters[SENSOR_PARAMETERS];
    double start; /* [s] time of the first sample */
    double sensed[SENSED_READINGS];
    double last[MOTION_NUMBERS]; /* motion at the last sample */
    double last_time;            /* [s] since the start */
    int64_t samples;
    generator_t standard;
#if HAS_IMU
    generator_t imu;
    double imu_bias[6];
#endif
#if HAS_COMPASS
    generator_t compass;
    double compass_phase; /* [rad] of the deviation */
#endif
#if HAS_DVL
    generator_t dvl;
    outages_t dvl_outages;
    double dvl_scale;
    double dvl_velocity[2];
    int64_t dvl_ping;
#endif
#if HAS_GNSS
    generator_t gnss;
    outages_t gnss_outages;
    double gnss_drift[2];
    double gnss_position[2];
    double gnss_path[GNSS_PATH][3]; /* time and position of the antenna */
    int64_t gnss_points, gnss_fix, gnss_last_fix;
#endif
} sensors_t;

#define SENSOR(name) (s->parameters[SENSOR_##name])

static generator_t sensor_stream(const sensors_t *s, uint32_t stream) {
    return seeded_generator((uint64_t)s->seed, &stream, 1);
}

/* One of the streams that a sensor's own stream spawns. */
INLINE generator_t spawned_stream(const sensors_t *s, uint32_t stream, uint32_t child) {
    uint32_t key[SEED_KEY] = {stream, child};
    return seeded_generator((uint64_t)s->seed, key, SEED_KEY);
}

/* Rotation matrix from body axes to north, east and down (Fossen 2021, eq. 2.31). */
static void body_to_earth(double phi, double theta, double psi, double turn[3][3]) {
    double cf = cos(phi), sf = sin(phi), ct = cos(theta), st = sin(theta);
    double cp = cos(psi), sp = sin(psi);
    double rows[3][3] = {
        {cp * ct, cp * st * sf - sp * cf, sp * sf + cp * cf * st},
        {sp * ct, cp * cf + sf * st * sp, st * sp * cf - cp * sf},
        {-st, ct * sf, ct * cf},
    };
    memcpy(turn, rows, sizeof rows);
}

static void turned(double turn[3][3], const double *v, double *result) {
    for (int i = 0; i < 3; i++)
        result[i] = turn[i][0] * v[0] + turn[i][1] * v[1] + turn[i][2] * v[2];
}

static void turned_back(double turn[3][3], const double *v, double *result) {
    for (int i = 0; i < 3; i++)
        result[i] = turn[0][i] * v[0] + turn[1][i] * v[1] + turn[2][i] * v[2];
}

INLINE void rotation_of(const double *motion, double turn[3][3]) {
    body_to_earth(motion[M_PHI], motion[M_THETA], motion[M_PSI], turn);
}

/* Velocity over ground of a place ahead, to starboard and below of the origin, in body axes. */
static void velocity_of(const double *m, const double *place, double *v) {
    v[0] = m[M_U] + m[M_Q] * place[2] - m[M_R] * place[1];
    v[1] = m[M_V] + m[M_R] * place[0] - m[M_P] * place[2];
    v[2] = m[M_W] + m[M_P] * place[1] - m[M_Q] * place[0];
}

/* Acceleration of a place since the last sample, less that of gravity, in earth axes. */
static void lifted_acceleration(
    const sensors_t *s, const double *m, double t, const double *place, double *result) {
    double turn[3][3], own[3], now[3] = {0}, before[3] = {0};
    double elapsed = 1.0;
    if (s->samples && t > s->last_time) {
        elapsed = t - s->last_time;
        rotation_of(m, turn);
        velocity_of(m, place, own);
        turned(turn, own, now);
        rotation_of(s->last, turn);
        velocity_of(s->last, place, own);
        turned(turn, own, before);
    }
    for (int i = 0; i < 3; i++) result[i] = (now[i] - before[i]) / elapsed;
    result[2] -= STANDARD_GRAVITY;
}

static outages_t started_outages(generator_t errors, double interval) {
    outages_t found = {errors, INFINITY, 0};
    if (interval > 0.0) found.next = interval * random_exponential(&found.errors);
    return found;
}

/* Whether there is an outage at a time, which is not before that of the last call. */
static bool is_out(outages_t *o, double t, double interval, double length) {
    while (t >= o->next) {
        o->out = !o->out;
        o->next += (o->out ? length : interval) * random_exponential(&o->errors);
    }
    return o->out;
}

/* Standard sensors
   --------------------------------------------------------------------------------------------- */

static void read_standard_sensors(sensors_t *s) {
    double *x = s->sensed, noise[STANDARD_NOISES];
    if (STANDARD_SENSORS_ARE_IDEAL) return;
    for (int i = 0; i < STANDARD_NOISES; i++) noise[i] = random_normal(&s->standard);
    double speed_sd = SENSOR(SENSORS_SPEED_SD), position_sd = SENSOR(SENSORS_POSITION_SD);
    double bias = SENSOR(SENSORS_ACCELERATION_BIAS), spread = SENSOR(SENSORS_ACCELERATION_SD);
    x[S_PSI] += SENSOR(SENSORS_HEADING_SD) * noise[0];
    x[S_R] = x[S_R] + SENSOR(SENSORS_GYRO_BIAS) + SENSOR(SENSORS_GYRO_SD) * noise[1];
    x[S_AX] = x[S_AX] + bias + spread * noise[2];
    x[S_AY] = x[S_AY] + bias + spread * noise[3];
    x[S_U] = speed_sd >= 0.0 ? x[S_U] + speed_sd * noise[4] : NAN;
    x[S_X] = position_sd >= 0.0 ? x[S_X] + position_sd * noise[5] : NAN;
    x[S_Y] = position_sd >= 0.0 ? x[S_Y] + position_sd * noise[6] : NAN;
    x[S_V] = x[S_PHI] = x[S_P] = NAN;
}

/* Inertial unit
   --------------------------------------------------------------------------------------------- */

#if HAS_IMU
static void start_imu(sensors_t *s) {
    s->imu = sensor_stream(s, STREAM_IMU);
    for (int i = 0; i < 6; i++) {
        double spread = i < 3 ? SENSOR(IMU_GYRO_BIAS_SD) : SENSOR(IMU_ACCELEROMETER_BIAS_SD);
        s->imu_bias[i] = spread * random_normal(&s->imu);
    }
}

static void read_imu(sensors_t *s, const double *m, double t) {
    double place[3] = {SENSOR(IMU_AHEAD), SENSOR(IMU_STARBOARD), -SENSOR(IMU_ABOVE)};
    double value[6], noise[12], turn[3][3], before[3][3], lifted[3];
    lifted_acceleration(s, m, t, place, lifted);
    rotation_of(m, turn);
    memcpy(value, m + M_P, 3 * sizeof(double));
    if (s->samples) {
        rotation_of(s->last, before);
        for (int i = 0; i < 3; i++) {
            value[i] = 0.5 * (value[i] + s->last[M_P + i]);
            for (int k = 0; k < 3; k++) turn[i][k] = 0.5 * (turn[i][k] + before[i][k]);
        }
    }
    turned_back(turn, lifted, value + 3);
    for (int i = 0; i < 12; i++) noise[i] = random_normal(&s->imu);
    double elapsed = s->samples ? t - s->last_time : 0.0;
    for (int i = 0; i < 6; i++) {
        double walk = i < 3 ? SENSOR(IMU_GYRO_WALK) : SENSOR(IMU_ACCELEROMETER_WALK);
        double white = i < 3 ? SENSOR(IMU_GYRO_NOISE) : SENSOR(IMU_ACCELEROMETER_NOISE);
        if (elapsed > 0.0) {
            s->imu_bias[i] += walk * sqrt(elapsed) * noise[i];
            value[i] += white / sqrt(elapsed) * noise[6 + i];
        }
        value[i] += s->imu_bias[i];
    }
    static const int readings[] = {S_P, S_Q, S_R, S_AX, S_AY, S_AZ};
    for (int i = 0; i < 6; i++) s->sensed[readings[i]] = value[i];
}
#endif

/* Magnetic compass
   --------------------------------------------------------------------------------------------- */

#if HAS_COMPASS
static void start_compass(sensors_t *s) {
    s->compass = sensor_stream(s, STREAM_COMPASS);
    s->compass_phase = 2.0 * PI * random_uniform(&s->compass);
}

static void read_compass(sensors_t *s, const double *m, double t) {
    double turn[3][3], level[3][3], force[3], lifted[3], own[3];
    double origin[3] = {0}, roll = 0.0, pitch = 0.0, dip = SENSOR(COMPASS_DIP);
    double earth[3] = {cos(dip), 0.0, sin(dip)};
    rotation_of(m, turn);
    if (COMPASS_COMPENSATION == COMPASS_EXACT) {
        roll = m[M_PHI];
        pitch = m[M_THETA];
    } else if (COMPASS_COMPENSATION == COMPASS_ACCELEROMETER) {
        lifted_acceleration(s, m, t, origin, lifted);
        turned_back(turn, lifted, force);
        roll = atan2(-force[1], -force[2]);
        pitch = atan2(force[0], hypot(force[1], force[2]));
    }
    turned_back(turn, earth, own);
    body_to_earth(roll, pitch, 0.0, level);
    turned(level, own, force);
    double error = remainder_real(atan2(-force[1], force[0]) - m[M_PSI] + PI, 2.0 * PI) - PI;
    error += SENSOR(COMPASS_DEVIATION) * sin(m[M_PSI] + s->compass_phase);
    error += SENSOR(COMPASS_HEADING_SD) * random_normal(&s->compass);
    s->sensed[S_PSI] = m[M_PSI] + error;
}
#endif

/* Doppler velocity log
   --------------------------------------------------------------------------------------------- */

#if HAS_DVL
static void start_dvl(sensors_t *s) {
    s->dvl = spawned_stream(s, STREAM_DVL, 0);
    s->dvl_outages = started_outages(spawned_stream(s, STREAM_DVL, 1), SENSOR(DVL_OUTAGE_INTERVAL));
    s->dvl_scale = 1.0 + SENSOR(DVL_SCALE_SD) * random_normal(&s->dvl);
    s->dvl_ping = -1;
    s->dvl_velocity[0] = s->dvl_velocity[1] = NAN;
}

static void read_dvl(sensors_t *s, const double *m, double t) {
    double place[3] = {SENSOR(DVL_AHEAD), SENSOR(DVL_STARBOARD), SENSOR(DVL_BELOW)};
    double v[3];
    int64_t ping = (int64_t)floor(t * SENSOR(DVL_RATE) + SAMPLE_EXACT);
    if (ping > s->dvl_ping) {
        s->dvl_ping = ping;
        velocity_of(m, place, v);
        bool out = is_out(
            &s->dvl_outages, t, SENSOR(DVL_OUTAGE_INTERVAL), SENSOR(DVL_OUTAGE_LENGTH));
        bool tilted = cos(m[M_PHI]) * cos(m[M_THETA]) < cos(SENSOR(DVL_LARGEST_TILT));
        for (int i = 0; i < 2; i++) {
            double noise = random_normal(&s->dvl);
            double found = s->dvl_scale * v[i] + SENSOR(DVL_SPEED_SD) * noise;
            s->dvl_velocity[i] = out || tilted ? NAN : found;
        }
    }
    s->sensed[S_U] = s->dvl_velocity[0];
    s->sensed[S_V] = s->dvl_velocity[1];
}
#endif

/* Satellite receiver
   --------------------------------------------------------------------------------------------- */

#if HAS_GNSS
static void start_gnss(sensors_t *s) {
    s->gnss = spawned_stream(s, STREAM_GNSS, 0);
    s->gnss_outages =
        started_outages(spawned_stream(s, STREAM_GNSS, 1), SENSOR(GNSS_OUTAGE_INTERVAL));
    for (int i = 0; i < 2; i++) s->gnss_drift[i] = SENSOR(GNSS_DRIFT_SD) * random_normal(&s->gnss);
    s->gnss_points = s->gnss_last_fix = 0;
    s->gnss_fix = -1;
    s->gnss_position[0] = s->gnss_position[1] = NAN;
}

static void remove_first_point(sensors_t *s) {
    s->gnss_points--;
    memmove(s->gnss_path, s->gnss_path + 1, (size_t)s->gnss_points * sizeof s->gnss_path[0]);
}

/* Position of the antenna at a time, linear between two samples. */
static void antenna_at(sensors_t *s, double t, double *position) {
    while (s->gnss_points > 1 && s->gnss_path[1][0] <= t) remove_first_point(s);
    const double *first = s->gnss_path[0], *second = s->gnss_path[1];
    double share = 0.0;
    if (s->gnss_points > 1 && t > first[0]) share = (t - first[0]) / (second[0] - first[0]);
    for (int i = 1; i < 3; i++)
        position[i - 1] = share > 0.0 ? first[i] + (second[i] - first[i]) * share : first[i];
}

static void take_fix(sensors_t *s) {
    double noise[4], antenna[2], rate = SENSOR(GNSS_RATE);
    double t = (double)++s->gnss_fix / rate;
    for (int i = 0; i < 4; i++) noise[i] = random_normal(&s->gnss);
    if (s->gnss_fix) {
        double keeps = exp(-1.0 / (rate * SENSOR(GNSS_DRIFT_TIME)));
        double spread = SENSOR(GNSS_DRIFT_SD) * sqrt(1.0 - keeps * keeps);
        for (int i = 0; i < 2; i++)
            s->gnss_drift[i] = keeps * s->gnss_drift[i] + spread * noise[i];
    }
    bool out = is_out(
        &s->gnss_outages, t, SENSOR(GNSS_OUTAGE_INTERVAL), SENSOR(GNSS_OUTAGE_LENGTH));
    antenna_at(s, t, antenna);
    for (int i = 0; i < 2; i++) {
        double error = s->gnss_drift[i] + SENSOR(GNSS_POSITION_SD) * noise[2 + i];
        s->gnss_position[i] = out ? NAN : antenna[i] + error;
    }
    if (!out) s->gnss_last_fix = s->gnss_fix;
}

static void read_gnss(sensors_t *s, const double *m, double t) {
    double antenna[3] = {SENSOR(GNSS_AHEAD), SENSOR(GNSS_STARBOARD), -SENSOR(GNSS_ABOVE)};
    double turn[3][3], away[3], rate = SENSOR(GNSS_RATE);
    rotation_of(m, turn);
    turned(turn, antenna, away);
    if (s->gnss_points == GNSS_PATH) remove_first_point(s);
    double *point = s->gnss_path[s->gnss_points++];
    point[0] = t;
    point[1] = m[M_X] + away[0];
    point[2] = m[M_Y] + away[1];
    double newest = fmax(floor((t - SENSOR(GNSS_LATENCY)) * rate + SAMPLE_EXACT), 0.0);
    while (s->gnss_fix < newest) take_fix(s);
    s->sensed[S_X] = s->gnss_position[0];
    s->sensed[S_Y] = s->gnss_position[1];
    s->sensed[S_AGE] = t - (double)s->gnss_last_fix / rate;
}
#endif

/* All sensors
   --------------------------------------------------------------------------------------------- */

/* Time at which the next sample is due: no sum of periods, in which rounding errors would grow. */
static double next_sample(const sensors_t *s) { return s->start + (double)s->samples * SAMPLE_PERIOD; }

static void start_sensors(sensors_t *s, double start) {
    s->start = start;
    s->samples = 0;
    s->standard = sensor_stream(s, STREAM_STANDARD);
#if HAS_IMU
    start_imu(s);
#endif
#if HAS_COMPASS
    start_compass(s);
#endif
#if HAS_DVL
    start_dvl(s);
#endif
#if HAS_GNSS
    start_gnss(s);
#endif
}

/* Take a sample: `readings` are those of `INSTRUMENTS`, `motion` those of `MeasuredMotion`;
   t [s] since the start. */
static void read_sensors(sensors_t *s, const double *readings, const double *motion, double t) {
    memcpy(s->sensed, readings, INSTRUMENT_READINGS * sizeof(double));
    read_standard_sensors(s);
#if HAS_IMU
    read_imu(s, motion, t);
#endif
#if HAS_COMPASS
    read_compass(s, motion, t);
#endif
#if HAS_DVL
    read_dvl(s, motion, t);
#endif
#if HAS_GNSS
    read_gnss(s, motion, t);
#endif
    memcpy(s->last, motion, sizeof s->last);
    s->last_time = t;
    s->samples++;
}
