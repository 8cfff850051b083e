/* Random numbers of NumPy's default generator, so that a seed gives the sensor errors of
   `boatsim run`. The tables of the ziggurat method, which are generated, are included before.
   Generator: PCG XSL RR 128/64, M. E. O'Neill, HMC-CS-2014-0905, 2014. Seeds: the hash of NumPy's
   SeedSequence, https://numpy.org/doc/stable/reference/random/bit_generators/ */

#define POOL 4     /* words of a seed sequence */
#define SEED_KEY 2 /* words of a key that distinguishes the streams of one seed */

/* State and increment of a generator, 128 bits each */
typedef struct { uint64_t high, low, step_high, step_low; } generator_t;

typedef unsigned __int128 wide_t;

INLINE wide_t joined(uint64_t high, uint64_t low) { return (wide_t)high << 64 | low; }

static void advance_generator(generator_t *g) {
    wide_t factor = joined(UINT64_C(2549297995355413924), UINT64_C(4865540595714422341));
    wide_t state = joined(g->high, g->low) * factor + joined(g->step_high, g->step_low);
    g->high = (uint64_t)(state >> 64);
    g->low = (uint64_t)state;
}

static uint64_t random_word(generator_t *g) {
    advance_generator(g);
    uint64_t folded = g->high ^ g->low;
    int turn = (int)(g->high >> 58);
    return folded >> turn | folded << (-turn & 63);
}

/* Uniform in [0, 1) */
static double random_uniform(generator_t *g) { return (double)(random_word(g) >> 11) * 0x1p-53; }

static double random_normal(generator_t *g) {
    for (;;) {
        uint64_t word = random_word(g);
        int layer = (int)(word & 255);
        bool negative = word >> 8 & 1;
        uint64_t position = word >> 9 & UINT64_C(0xfffffffffffff);
        double x = (double)position * NORMAL_WIDTH[layer];
        if (negative) x = -x;
        if (position < NORMAL_SURE[layer]) return x;
        if (layer == 0) {
            for (;;) { /* the tail, after Marsaglia */
                double beyond = -log1p(-random_uniform(g)) / NORMAL_RADIUS;
                double other = -log1p(-random_uniform(g));
                if (other + other > beyond * beyond)
                    return position >> 8 & 1 ? -(NORMAL_RADIUS + beyond) : NORMAL_RADIUS + beyond;
            }
        }
        double low = NORMAL_HEIGHT[layer], high = NORMAL_HEIGHT[layer - 1];
        if (low + (high - low) * random_uniform(g) < exp(-0.5 * x * x)) return x;
    }
}

static double random_exponential(generator_t *g) {
    for (;;) {
        uint64_t word = random_word(g) >> 3;
        int layer = (int)(word & 255);
        uint64_t position = word >> 8;
        double x = (double)position * EXPONENTIAL_WIDTH[layer];
        if (position < EXPONENTIAL_SURE[layer]) return x;
        if (layer == 0) return EXPONENTIAL_RADIUS - log1p(-random_uniform(g));
        double low = EXPONENTIAL_HEIGHT[layer], high = EXPONENTIAL_HEIGHT[layer - 1];
        if (low + (high - low) * random_uniform(g) < exp(-x)) return x;
    }
}

/* Seeds
   --------------------------------------------------------------------------------------------- */

static uint32_t hashed(uint32_t value, uint32_t *constant) {
    value ^= *constant;
    *constant *= UINT32_C(0x931e8875);
    value *= *constant;
    return value ^ value >> 16;
}

static uint32_t mixed(uint32_t a, uint32_t b) {
    uint32_t found = UINT32_C(0xca01f9dd) * a - UINT32_C(0x4973f715) * b;
    return found ^ found >> 16;
}

/* Begin the stream of a seed with a key of `count` words, as children of a seed sequence have. */
static generator_t seeded_generator(uint64_t seed, const uint32_t *key, int count) {
    uint32_t pool[POOL] = {(uint32_t)seed, (uint32_t)(seed >> 32)};
    uint32_t constant = UINT32_C(0x43b0d7e5);
    for (int i = 0; i < POOL; i++) pool[i] = hashed(pool[i], &constant);
    for (int i = 0; i < POOL; i++)
        for (int k = 0; k < POOL; k++)
            if (i != k) pool[k] = mixed(pool[k], hashed(pool[i], &constant));
    for (int i = 0; i < count; i++)
        for (int k = 0; k < POOL; k++) pool[k] = mixed(pool[k], hashed(key[i], &constant));
    uint64_t words[POOL];
    constant = UINT32_C(0x8b51f9dd);
    for (int i = 0; i < 2 * POOL; i++) {
        uint32_t value = pool[i % POOL] ^ constant;
        constant *= UINT32_C(0x58f38ded);
        value *= constant;
        value ^= value >> 16;
        if (i % 2) words[i / 2] |= (uint64_t)value << 32;
        else words[i / 2] = value;
    }
    wide_t step = joined(words[2], words[3]) << 1 | 1;
    wide_t state = step + joined(words[0], words[1]);
    generator_t g = {(uint64_t)(state >> 64), (uint64_t)state, (uint64_t)(step >> 64), (uint64_t)step};
    advance_generator(&g);
    return g;
}
