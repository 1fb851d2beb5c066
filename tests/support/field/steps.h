/* Asynchronous steps of meshes, for tests. */
#ifndef TESTS_SUPPORT_FIELD_STEPS_H
#define TESTS_SUPPORT_FIELD_STEPS_H
#include "field/avi/avi.h"
#include "support/field/generated.h"

/* A mesh with its star, and the terms of a k-form on it. */
typedef struct stepped {
  dvi_mesh *mesh;
  dvi_star *star;
  int64_t edges, faces, nodes;
  int8_t *is_fixed; /* [edges], the boundary if it is fixed */
  dvi__avi_terms terms;
} stepped;

/* Take a mesh, which the result owns then. */
stepped stepped_mesh(dvi_mesh *mesh, int k, int is_fixed);
void end_stepped(stepped *s);

/* Give the rectangles of a mesh steps of fraction/sqrt(1/hx^2 + 1/hy^2), or else the largest powers
 * of 2 of the shortest of them that are not longer. */
void step_of_boxes(const dvi_mesh *mesh, double fraction, int is_free, double *step);

/* Start with random E, and A = 0. */
void start_at_random(const stepped *s, dvi__avi *avi, unsigned long long seed);

dvi__avi *avi_of(const dvi__avi_terms *terms);
double energy_of(const dvi__avi *avi);
void advance_to(dvi__avi *avi, double t);

/* A mesh with currents and dampings at every third edge. */
typedef struct loaded {
  stepped s;
  double *damping, *profile[2];
  dvi__avi_current current[2];
} loaded;

/* Make `currents` of them, cos(3 t) and noise, and dampings up to `damping` beside the mass. */
void load_steps(loaded *l, int currents, double damping);
void end_loaded(loaded *l);

/* A signal without any order, between -1 and 1. */
dvi_status noise_signal(double from, double to, double *impulse, void *user);

/* Meshes with several classes: triangles and boxes, waves and Maxwell's equations. */
enum { STEPPED_MESHES = 5 };
stepped mesh_of_case(int i);

/* Memory for some numbers. */
double *zeros(int64_t count);

/* Sample a form, give all forms [2*edges + faces], and require equal bits of all. */
void take_form(const dvi__avi *avi, dvi_march_form form, double *values);
double *forms_of(const stepped *s, const dvi__avi *avi);
void check_same(const stepped *s, const dvi__avi *a, const dvi__avi *b);

/* Make a run from a random start to a time. */
dvi__avi *ran_steps(const dvi__avi_terms *terms, const stepped *s, double t);

/* Run a string of 12 unequal cells, under a current and dampings up to `damping` at a third of its
 * vertices, from a half wave to a time amid its steps, and give A, E and B. */
enum { STRING_VALUES = 13 + 13 + 12 };
void run_string(int is_free, double damping, double fraction, double *values);

/* Give the largest distance of such a run from the exact one. */
double string_error(int is_free, double damping, double fraction, const double *exact);

/* Take over the state of another run. */
void reload_steps(const dvi__avi *from, dvi__avi *to);

#endif
