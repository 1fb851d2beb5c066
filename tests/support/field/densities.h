/* Fields with densities for tests, whose parts are written by hand. */
#ifndef TESTS_SUPPORT_FIELD_DENSITIES_H
#define TESTS_SUPPORT_FIELD_DENSITIES_H
#include <dvi/density.h>
#include <dvi/integrator.h>

/* l = u_t^2/2, and l = -|grad u|^2/2 in one and two dimensions. */
extern const dvi_density_part kinetic_part, elastic_part, elastic_part_2d;
/* V = m^2 u^2/2 with m = 1.5, V = 1 - cos u, and V = (u^2-1)^2/4. */
extern const dvi_density_part klein_gordon_part, sine_gordon_part, double_well_part;

/* A space on the interval or square of these ends. */
dvi_space *make_density_space(const char *kind, int dimension, double from, double to,
                              int periodic);

/* A field with its space and its system. */
typedef struct density_field {
  dvi_space *space;
  dvi_density *density;
  dvi_system *system; /* NULL if there is none */
  int64_t n, places;
  double *q, *p, *U; /* [n], [n], [places] */
} density_field;

/* Makes a field of one component, which owns the space then. The test fails if it cannot. */
density_field make_density(dvi_space *space, const dvi_density_part *part, int parts,
                           const dvi_density_condition *condition, int conditions);
density_field make_density_of(dvi_space *space, dvi_density_terms terms);
void end_density(density_field *field);

/* Start values as functions of x [dimension*count], like those of dvi_space_interpolate. */
typedef int field_function(int64_t count, const double *x, double *f, void *user);

/* 1.5 + 0.5 cos x, and 0.3 sin x: pendula on a circle. */
field_function pendula_start, pendula_rate;

/* Values that move, u = sin(t - x), and their derivatives in time. */
int sine_datum(int64_t count, double t, const double *x, double *datum, void *user);
int sine_datum_rates(int64_t count, double t, const double *x, double *first, double *second,
                     void *user);

/* Sets q and p of a field of one component by its values and rates, each NULL for 0. */
void set_density(density_field *field, field_function *u, field_function *rate, void *user);

/* Requires that callbacks agree with differences at a state at random. */
void check_density(const density_field *field, double tolerance);

/* Runs a method from q and p over a time, and leaves the end there. */
void run_density(density_field *field, const char *method, double t, double h, int steps);

/* The value of a component of one at x at a time. */
double density_at(const density_field *field, double t, const double *x);

#endif
