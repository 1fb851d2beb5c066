/* Equations of a field's unknowns on all processes that hold shares of its mesh. */
#ifndef DVI_FIELD_MODEL_ON_ALL_H
#define DVI_FIELD_MODEL_ON_ALL_H
#include "field/model/elliptic.h"
#include "field/model/field.h"

/* Equations with the Jacobian mass M + losses S + stiffness K + D, as in field/model/elliptic.h. */
typedef struct dvi__field_equations {
  const dvi_field *field;
  double mass, stiffness; /* factors of M and K. Both 0: K alone */
  const double *loss;     /* [unknowns] the diagonal S, or NULL */
  double losses;          /* its factor */
  double cosine, sine;    /* of equations of pairs, or both 0 */
  dvi_status (*residual)(void *of, const double *x, double *r);
  dvi_status (*diagonal)(void *of, const double *x, double *d);
  void *of;
  double rounding; /* as in dvi__elliptic */
} dvi__field_equations;

/* A solver that is kept. All zero before. */
typedef struct dvi__on_all {
  const dvi_ranks_solver *kind;
  void *solver;
} dvi__on_all;

/* Create a solver. DVI_UNSUPPORTED if the share came without one. On failure nothing is owned. */
dvi_status dvi__on_all_create(const dvi__field_equations *equations, dvi__on_all *made);
void dvi__on_all_clear(dvi__on_all *made);

/* Solve such equations once, with the solver that came with the share. */
dvi_status dvi__elliptic_solve_once(const dvi__elliptic *equations, double *x);

/* Solve once, from x [unknowns] on. Failures have a sentence, and leave x. */
dvi_status dvi__field_solve_on_all(const dvi__field_equations *equations, double *x,
                                   dvi__elliptic_report *report);

#endif
