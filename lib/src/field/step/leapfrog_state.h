/* The state of leapfrog's march, which is stepped and seen in leapfrog.c, and saved and loaded in
 * leapfrog_saved.c. */
#ifndef DVI_FIELD_STEP_LEAPFROG_STATE_H
#define DVI_FIELD_STEP_LEAPFROG_STATE_H
#include "field/algebra/conjugate.h"
#include "field/step/observables.h"
#include "field/step/saved.h"
#include "field/step/sweep.h"
#include "march/sections.h"

/* What stars that are not diagonal need: the matrix M + dt/2 S of a step, M, and room. */
typedef struct dvi__leapfrog_solver {
  dvi_matrix d, M2, matrix, mass;
  dvi__csr left; /* what `matrix` shows */
  dvi__products of_step, of_mass;
  double *room;      /* of all that follows */
  double *H, *curl;  /* [faces], [cells] */
  double *right, *x; /* [unknowns] */
  double *kept;      /* [numbers] the state before a step */
} dvi__leapfrog_solver;

typedef struct dvi__leapfrog {
  const dvi_field *field;
  dvi__sweep sweep;
  dvi__march_place at;
  double bound;
  int keeps_A; /* the field is a wave, A is wanted, or damping moves charge */
  int64_t numbers;
  double *state;       /* [numbers] all that follows in this block, and the charge's numbers */
  double *E, *H, *A;   /* E^{n+1/2}, B^n as field/step/sweep.h has it, A^n if it is kept */
  double *J;           /* [currents] means of the signals around t_n, or after t_0 */
  double *impulse;     /* [currents] integrals of the signals over the next step */
  double *keep, *gain; /* [cells] coefficients of diagonal stars; keep is NULL for 1 */
  double *inverse;     /* [unknowns] 1/(M + dt/2 S) of diagonal stars */
  double *source;      /* [unknowns] of a wave, or NULL */
  double *spare;       /* [cells + 2*faces] */
  double *change;      /* [cells] of stars that are not diagonal, E' at t_n once it is needed */
  int64_t changed;     /* that n, or -1 */
  int is_lost;         /* values have overflowed, or processes could not exchange them */
  dvi__charge charge;
  dvi__leapfrog_solver solver;
} dvi__leapfrog;

/* Put the state of the whole mesh into a file, and take it from one. See dvi__march_kind. */
dvi_status dvi__leapfrog_save(const void *self, dvi__sections_writer *writer);
dvi_status dvi__leapfrog_load(void *self, const dvi__sections *sections);

#endif
