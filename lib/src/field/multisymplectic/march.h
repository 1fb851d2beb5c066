/* A march on a lattice. */
#ifndef DVI_FIELD_MULTISYMPLECTIC_MARCH_H
#define DVI_FIELD_MULTISYMPLECTIC_MARCH_H
#include "field/multisymplectic/lattice.h"
#include "field/multisymplectic/solver.h"
#include "march/kind.h"

/* Levels are `step` steps behind t0, and one before and one after that. The momenta of a level are
 * the derivative of the action of the row below by it. All arrays are [size] but for two. */
typedef struct dvi__lattice_march {
  dvi__lattice lattice;
  int mean_rate;
  double t0, t;
  int64_t step;
  double *before, *now, *next, *p_now, *p_next;
  /* The matrix of a step, where it was computed, and if is_kept a place to go back to */
  dvi__lattice_solver solver;
  double factored_at, kept_at;
  int is_kept;
  double *factored[2], *kept[2];
  /* What a step computes */
  double *level, *p, *lower, *change; /* change [unknowns] */
  double *rate;
  double *all; /* memory of most arrays */
} dvi__lattice_march;

/* Make a march, and release what it owns. It may own things after a failure, too. */
dvi_status dvi__lattice_march_make(const dvi_multisymplectic_terms *terms, dvi__lattice_march *m);
void dvi__lattice_march_clear(dvi__lattice_march *m);

/* Compute and factor the matrix of a step between two levels. */
dvi_status dvi__lattice_factor(dvi__lattice_march *m, double t, const double *lower,
                               const double *upper);

/* Keep the place of the matrix, unless one is kept. Compute the matrix there if one is, and keep
 * none then. If that fails the next step tries again: what fails changes no bit of later steps. */
void dvi__lattice_keep_factor(dvi__lattice_march *m);
dvi_status dvi__lattice_restore_factor(dvi__lattice_march *m);

/* Start, and take a step. They change nothing if they fail. */
dvi_status dvi__lattice_start(void *self, const dvi_march_state *state);
dvi_status dvi__lattice_step(dvi__lattice_march *m);

/* ---- functions of the kind ---- */

int dvi__lattice_observables(const void *self);
const char *dvi__lattice_observable(const void *self, int i);
dvi_status dvi__lattice_observe(const void *self, int i, double *value);
dvi_status dvi__lattice_save(const void *self, dvi__sections_writer *writer);
dvi_status dvi__lattice_load(void *self, const dvi__sections *sections);

#endif
