/* Tents over meshes of space, with a form's values of a start or of a sample. */
#ifndef TESTS_SUPPORT_FIELD_TENTS_H
#define TESTS_SUPPORT_FIELD_TENTS_H
#include "field/tents/front.h"

typedef struct pitched {
  dvi_star *star;
  dvi__tents *tents;
  int k;
  int64_t size, above; /* k-cells and (k+1)-cells */
  double *A, *E, *B;   /* of a start, or of a sample */
} pitched;

/* Prepare tents. The mesh belongs to the star then. */
pitched tents_over(dvi_mesh *mesh, int k, const double *const *factor, const int8_t *held,
                   dvi__tents_options options);
void strike_tents(pitched *p);

/* Start from A and E, with B = dA. */
void start_tents(const pitched *p);
void advance_tents(const pitched *p, double t);
void sample_tents(const pitched *p);
double energy_of_tents(const pitched *p);

/* A plane wave of a form along x: cos or sin of 2 pi x, times each component's factor. */
typedef struct plane_wave {
  double factor[4];
  int is_sine, components;
} plane_wave;
void integrate_wave(const pitched *p, int k, plane_wave w, double *form);

/* Set u = sin(2 pi (x - c t)) and E = -u' at t = 0. */
void set_sine(const pitched *p, double c);

double largest_error(int64_t count, const double *a, const double *b);
void fill_at_random(int64_t count, double size, unsigned long long seed, double *form);

/* A mesh of each kind: circles and tori, with free boundaries, curved, and in space. */
typedef struct tent_place {
  const char *generator; /* NULL for those of tests */
  int n, across, up;
} tent_place;
enum { TENT_PLACES = 7 };
extern const tent_place tent_places[TENT_PLACES];
dvi_mesh *mesh_at(const tent_place *at);

#endif
