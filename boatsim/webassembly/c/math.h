/* Functions of the C library's math.h that WebAssembly has, and those that JavaScript gives. */
#ifndef BOATSIM_MATH_H
#define BOATSIM_MATH_H

#define NAN __builtin_nan("")
#define INFINITY __builtin_inf()
#define isnan(x) __builtin_isnan(x)
#define isinf(x) __builtin_isinf(x)
#define isfinite(x) __builtin_isfinite(x)
#define fabs(x) __builtin_fabs(x)
#define sqrt(x) __builtin_sqrt(x)
#define floor(x) __builtin_floor(x)
#define ceil(x) __builtin_ceil(x)
#define copysign(x, y) __builtin_copysign(x, y)

#define FROM_JAVASCRIPT(name) __attribute__((import_module("math"), import_name(name)))
FROM_JAVASCRIPT("cos") double cos(double x);
FROM_JAVASCRIPT("sin") double sin(double x);
FROM_JAVASCRIPT("tan") double tan(double x);
FROM_JAVASCRIPT("acos") double acos(double x);
FROM_JAVASCRIPT("asin") double asin(double x);
FROM_JAVASCRIPT("atan") double atan(double x);
FROM_JAVASCRIPT("exp") double exp(double x);
FROM_JAVASCRIPT("log") double log(double x);
FROM_JAVASCRIPT("sinh") double sinh(double x);
FROM_JAVASCRIPT("cosh") double cosh(double x);
FROM_JAVASCRIPT("tanh") double tanh(double x);
FROM_JAVASCRIPT("atan2") double atan2(double y, double x);
FROM_JAVASCRIPT("hypot") double hypot(double x, double y);
FROM_JAVASCRIPT("pow") double pow(double x, double y);
FROM_JAVASCRIPT("fmod") double fmod(double x, double y);

#endif
