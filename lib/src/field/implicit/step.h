/* Steps on shares of a mesh whose equations all processes solve together (field/model/on_all.h).
 * With the potential V and the load of a field they have forces
 *
 *     F(q) = K q - load + w V_u(q).
 *
 * Of Maxwell's fields K q = d^T M_{k+1} B, and B = dA has steps of its own. So no rounding grows
 * with A, whose static fields are gradients that grow with time, and F has no charge but where
 * numbers are added to p. */
#ifndef DVI_FIELD_IMPLICIT_STEP_H
#define DVI_FIELD_IMPLICIT_STEP_H
#include "field/model/on_all.h"
#include "field/step/sweep.h"

enum { DVI__FORCES = 2 }; /* that a rule holds at a time */

typedef struct dvi__rule dvi__rule;

/* A state at a time. Values of others' cells are refreshed. */
typedef struct dvi__implicit_state {
  double t;
  double *q, *p;     /* [cells] the form, and its momentum */
  double *B;         /* [faces] of Maxwell's fields */
  double *delivered; /* [currents] integrals of the signals since the start */
} dvi__implicit_state;

typedef struct dvi__implicit_step {
  const dvi_field *field;
  const dvi__rule *rule;
  const dvi__sweep *sweep; /* of Maxwell's fields, with the weights of all faces, or NULL */
  double h;
  dvi__on_all solver;
  const dvi__implicit_state *from;
  double signal[DVI__CURRENTS]; /* of currents, in this step */
  double *x;                    /* [numbers*unknowns] what the equations are solved for */
  double *place, *work;         /* [unknowns] */
  double *force[DVI__FORCES];   /* [unknowns] */
  double *form, *H;             /* [cells], [faces] of Maxwell's fields */
  double *loss;                 /* [unknowns] the diagonal of S, or NULL without one */
  int knows_force;              /* the first force is that at the start, of the last step's end */
} dvi__implicit_step;

/* How a step is taken. */
struct dvi__rule {
  const char *name; /* of its section in files */
  int numbers;      /* x of each unknown, 1 or 2 */
  int forces;       /* that it holds */
  /* Fill in what depends on the rule: the Jacobian, residual and diagonal. */
  void (*equations)(const dvi__implicit_step *s, dvi__field_equations *equations);
  dvi_status (*begin)(dvi__implicit_step *s); /* set x near a solution */
  /* Find what `move` needs beside x and the last residual's forces. NULL for nothing. Both may fail
   * on one process alone. */
  dvi_status (*end)(dvi__implicit_step *s);
  /* Move q and p of the unknown i. */
  void (*move)(const dvi__implicit_step *s, int64_t i, double *q, double *p);
  /* Move B and what currents have delivered. NULL for rules of waves alone. */
  void (*move_rest)(const dvi__implicit_step *s, dvi__implicit_state *to);
};

extern const dvi__rule dvi__midpoint_rule, dvi__imex_rule, dvi__gauss_rule;

/* Prepare steps with the field, rule, sweep and h of `wanted`. Called on all processes. On failure
 * nothing is owned. */
dvi_status dvi__implicit_step_create(const dvi__implicit_step *wanted, dvi__implicit_step **made);
void dvi__implicit_step_destroy(dvi__implicit_step **made);

/* Make a step. It begins where the last one ended, unless knows_force is 0. On failure `to` stays
 * as it was, but where processes could not give each other their values, which sets *is_lost. The
 * report is that of the solver. */
dvi_status dvi__implicit_take(dvi__implicit_step *step, const dvi__implicit_state *from,
                              dvi__implicit_state *to, int *is_lost, dvi__elliptic_report *report);

/* Refuse what the potential returned. */
dvi_status dvi__implicit_refuse(int failed);

/* ---- for rules ---- */

/* Set `force` [unknowns] to F at the places q + by x, or at q if x is NULL, right for own unknowns.
 */
dvi_status dvi__implicit_force(dvi__implicit_step *s, double by, const double *x, double *force);

/* Set d [unknowns] to factor w V_uu at q + by x. */
dvi_status dvi__implicit_diagonal(dvi__implicit_step *s, double factor, double by, const double *x,
                                  double *d);

/* Refuse a step if an own M + times d, which is M + h^2/4 w V_uu, is not positive: it may have
 * several solutions then, of which Newton's method finds any. */
dvi_status dvi__implicit_check_curvature(const dvi__implicit_step *s, double times,
                                         const double *d);

#endif
