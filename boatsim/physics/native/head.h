/* Arrays and small functions for the C source of a vessel's program. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

/* Branches stay branches: those of laws and actuators are predicted nearly always, while conditional
   moves compute both cases and wait for the condition. As a pragma, because other compilers refuse
   the flag. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-if-conversion")
#endif

#define INLINE static inline __attribute__((always_inline))

/* An argument of a function that Python calls: a number, or an address */
typedef union { double real; int64_t whole; void *at; } word_t;

/* Contiguous arrays, row by row */
typedef struct { double *d; int64_t n0; } array1_t;
typedef struct { double *d; int64_t n0, n1; } array2_t;
typedef struct { double *d; int64_t n0, n1, n2; } array3_t;
typedef struct { int64_t *d; int64_t n0; } rows1_t;

/* Entries */
INLINE int64_t *at1_rows(rows1_t a, int64_t i) { return a.d + i; }
INLINE double *at1(array1_t a, int64_t i) { return a.d + i; }
INLINE double *at2(array2_t a, int64_t i, int64_t j) { return a.d + i * a.n1 + j; }
INLINE double *at3(array3_t a, int64_t i, int64_t j, int64_t k) {
    return a.d + (i * a.n1 + j) * a.n2 + k;
}

/* An index that counts from the end of n entries if it is negative */
INLINE int64_t wrapped(int64_t i, int64_t n) { return i < 0 ? i + n : i; }

/* Rows, and consecutive entries or rows from i to before j; negative bounds count from the end */
INLINE array1_t row_of2(array2_t a, int64_t i) { return (array1_t){a.d + i * a.n1, a.n1}; }
INLINE array2_t row_of3(array3_t a, int64_t i) {
    return (array2_t){a.d + i * a.n1 * a.n2, a.n1, a.n2};
}
INLINE array1_t line_of3(array3_t a, int64_t i, int64_t j) {
    return (array1_t){a.d + (i * a.n1 + j) * a.n2, a.n2};
}
INLINE int64_t bound(int64_t i, int64_t n) {
    if (i < 0) i += n;
    return i < 0 ? 0 : i > n ? n : i;
}
INLINE array1_t part_of1(array1_t a, int64_t i, int64_t j) {
    i = bound(i, a.n0);
    j = bound(j, a.n0);
    return (array1_t){a.d + i, j > i ? j - i : 0};
}
INLINE array2_t part_of2(array2_t a, int64_t i, int64_t j) {
    i = bound(i, a.n0);
    j = bound(j, a.n0);
    return (array2_t){a.d + i * a.n1, j > i ? j - i : 0, a.n1};
}
INLINE void fill1(array1_t a, double x) {
    for (int64_t i = 0; i < a.n0; i++) a.d[i] = x;
}
/* Copy b to a, which may be parts of one array. */
INLINE void copy1(array1_t a, array1_t b) {
    int64_t n = a.n0 < b.n0 ? a.n0 : b.n0;
    if (a.d <= b.d)
        for (int64_t i = 0; i < n; i++) a.d[i] = b.d[i];
    else
        for (int64_t i = n - 1; i >= 0; i--) a.d[i] = b.d[i];
}

/* Memory that is freed when its function returns */
static inline void release_real(double **p) { free(*p); }
static inline void release_whole(int64_t **p) { free(*p); }
#define RELEASED(kind) __attribute__((cleanup(release_##kind)))

/* Python's functions, with nan and ties as in numba */
INLINE double least_real(double a, double b) { return b < a ? b : a; }
INLINE double most_real(double a, double b) { return b > a ? b : a; }
INLINE int64_t least_whole(int64_t a, int64_t b) { return b < a ? b : a; }
INLINE int64_t most_whole(int64_t a, int64_t b) { return b > a ? b : a; }
INLINE double lesser(double a, double b) { return isnan(a) || a < b ? a : b; }
INLINE double greater(double a, double b) { return isnan(a) || a > b ? a : b; }
INLINE double sign_of(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x; }
INLINE int64_t magnitude(int64_t x) { return x < 0 ? -x : x; }
/* Quotient and remainder rounded down; 0 as in numba where there is none or it overflows */
INLINE bool divides(int64_t a, int64_t b) { return b != 0 && (b != -1 || a != INT64_MIN); }
INLINE int64_t quotient(int64_t a, int64_t b) {
    if (!divides(a, b)) return 0;
    return a / b - (a % b != 0 && (a < 0) != (b < 0));
}
INLINE int64_t remainder_whole(int64_t a, int64_t b) {
    return divides(a, b) ? a - quotient(a, b) * b : 0;
}
INLINE double remainder_real(double a, double b) {
    double m = fmod(a, b);
    return m != 0.0 && (m < 0.0) != (b < 0.0) ? m + b : m;
}
INLINE double degrees_of(double x) { return x * 0x1.ca5dc1a63c1f8p+5; }  /* 180 / pi */
INLINE double radians_of(double x) { return x * 0x1.1df46a2529d39p-6; }  /* pi / 180 */
INLINE double power2(double x) { return x * x; }
INLINE double power3(double x) { return x * (x * x); }
INLINE double power4(double x) { return (x * x) * (x * x); }
