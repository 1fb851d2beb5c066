/* Kinds of dynamics, which are the forms of a system's equations of motion.
 *
 * Each kind is one const struct in a file of its own, listed in system/declare/dynamics.def. The
 * driver, checkpoints, invariants, diagnostics and judges call these functions and ask no kind by
 * name. The bits of dvi__term say what a method can use. */
#ifndef DVI_SYSTEM_EVALUATE_DYNAMICS_H
#define DVI_SYSTEM_EVALUATE_DYNAMICS_H
#include "system/evaluate/evaluator.h"

/* The form in which the judges of room reference integrate the motion. */
typedef enum dvi__motion_form {
  DVI__EULER_LAGRANGE, /* q' = v, p' = L_q, p = L_v */
  DVI__FIRST_ORDER,    /* Omega(q) q' = H_q, without momenta of their own */
  /* q' = v, p' = L_q - G^T lambda, p = L_v, phi(t,q) = 0, A v + a = 0 */
  DVI__CONSTRAINED_LAGRANGE,
  DVI__HAMILTON, /* q' = H_p, p' = -H_q, and the forces of constraints phi(q,p) = 0 */
  DVI__LIFTED    /* on rotations and directions, lifted to coordinates of R^n */
} dvi__motion_form;

/* A constraint that every state of the system fulfils, p = alpha(q), or phi(q,p) = 0, or phi(t,q) =
 * 0 and its rate, or A v + a = 0. */
typedef struct dvi__state_constraint {
  const char *matrix; /* name of the matrix at whose singular points trajectories end */

  /* Return DVI_BAD_ARGUMENT unless the state fulfils the constraint up to rounding. */
  dvi_status (*check)(dvi__evaluator *e, double t, const double *q, const double *p);

  /* Refuse a declaration that cannot be of its kind near a point. NULL if there is none. */
  dvi_status (*admit)(dvi__evaluator *e, double t, const double *q);

  /* Move q and p [n] onto the constraint. */
  dvi_status (*project)(dvi__evaluator *e, double t, double *q, double *p);

  /* Compute the largest violation, and the size by which it is measured. */
  dvi_status (*distance)(dvi__evaluator *e, double t, const double *q, const double *p,
                         double *distance);
  dvi_status (*size)(dvi__evaluator *e, double t, const double *q, const double *p, double *size);

  /* Find the side of the singular points on which the state lies. This is the sign of the matrix's
   * Pfaffian, 0 at such a point. Beyond DVI__SIDES_MOST rows the side is always 1, because the sign
   * would cost as much as a step. If `has_rank` it is 1 + the number of dependent rows, and is
   * asked for at a start, too. `before` is the side of the step's start, or 0 if none is known. */
  dvi_status (*side)(dvi__evaluator *e, double t, const double *q, const double *p, int before,
                     int *side);
  int has_rank;

  /* Return 1 if the trajectory from q seems to end within h at a singular point. v, ahead [n] are
   * work. NULL if this is unknown. */
  int (*ends)(dvi__evaluator *e, double t, const double *q, double h, double *v, double *ahead);
} dvi__state_constraint;

struct dvi__dynamics {
  const char *name;     /* name such as "constant mass" */
  const char *function; /* name of the callbacks' function, "Lagrangian" or "Hamiltonian" */
  dvi__motion_form equations;
  int by_momentum;        /* the functions take (q,p), and p is passed as v below */
  int searches_velocity;  /* `velocity` is an iteration, and v holds its guess */
  int has_kinetic_energy; /* the energy has the part p.v/2, and forces L_q change p */
  int on_manifold;        /* q are not coordinates of R^n */
  /* reason and remedy if there are no Taylor coefficients, or NULL if terms may have them */
  const char *no_taylor;
  const char *symmetric; /* names of its symmetric methods in words, or NULL for the usual ones */

  /* Test if the terms declare this kind. Check and copy them into the system, with its term
   * bits. */
  int (*is_declared)(const dvi_system_terms *terms);
  dvi_status (*declare)(const dvi_system_terms *terms, dvi_system *system);

  /* Create and destroy the kind's part of an evaluator, e->own and e->velocity. release may be
   * NULL. */
  dvi_status (*prepare)(dvi__evaluator *e, dvi__derivatives most);
  void (*release)(dvi__evaluator *e);

  /* Compute the velocity v of one state (t,q,p). v is unchanged on failure. */
  dvi_status (*velocity)(dvi__evaluator *e, double t, const double *q, const double *p, double *v);
  /* Return DVI_SINGULAR if no velocity, or no motion, is defined at the state. NULL if always
   * defined. */
  dvi_status (*regular)(dvi__evaluator *e, double t, const double *q, const double *v);
  /* Compute both rates, and the multipliers of phi(q,p) = 0 if `multiplier` is not NULL. v is as
   * above. NULL if the lifted equations have the rates. */
  dvi_status (*motion)(dvi__evaluator *e, double t, const double *q, const double *p, double *v,
                       double *pdot, double *multiplier);
  dvi_status (*energy)(dvi__evaluator *e, double t, const double *q, const double *v,
                       const double *p, double *E);

  /* Compute the function L, and its derivatives L_q [nq] and L_v as momenta [nv], at stored
   * velocities. */
  dvi_status (*value)(dvi__evaluator *e, double t, const double *q, const double *v, double *L);
  dvi_status (*forces)(dvi__evaluator *e, double t, const double *q, const double *v, double *L_q);
  dvi_status (*momentum)(dvi__evaluator *e, double t, const double *q, const double *v, double *p);

  const dvi__state_constraint *constraint; /* NULL if every (q,p) is a state */

  /* Compute the multipliers of holonomic constraints at one state. NULL if there are none. */
  dvi_status (*reactions)(dvi__evaluator *e, double t, const double *q, const double *v,
                          double *lambda);
};

/* The kinds (system/declare/dynamics.def). The last two describe systems that the library
 * creates. */
extern const dvi__dynamics dvi__dynamics_charts, dvi__dynamics_constant_mass,
    dvi__dynamics_general_lagrangian, dvi__dynamics_constrained_mass,
    dvi__dynamics_constrained_lagrangian, dvi__dynamics_constrained_charts, dvi__dynamics_one_form,
    dvi__dynamics_hamiltonian, dvi__dynamics_constrained_hamiltonian,
    dvi__dynamics_time_transformed;

/* Return the argument of the system's functions beside q, which is p or v. */
static inline const double *dvi__second(const dvi_system *system, const double *v, const double *p)
{
  return system->dynamics->by_momentum ? p : v;
}

/* Functions that several kinds share (system/evaluate/state.c). */
dvi_status dvi__value_of_point(dvi__evaluator *e, double t, const double *q, const double *v,
                               double *L);
dvi_status dvi__forces_of_point(dvi__evaluator *e, double t, const double *q, const double *v,
                                double *L_q);
dvi_status dvi__momentum_of_point(dvi__evaluator *e, double t, const double *q, const double *v,
                                  double *p);
dvi_status dvi__energy_of_lagrangian(dvi__evaluator *e, double t, const double *q, const double *v,
                                     const double *p, double *E);
dvi_status dvi__motion_of_lagrangian(dvi__evaluator *e, double t, const double *q, const double *p,
                                     double *v, double *pdot, double *multiplier);

/* Fail with DVI_SINGULAR. */
dvi_status dvi__lagrangian_is_degenerate(double t);

/* Functions of the general Lagrangian that other kinds use. */
dvi_status dvi__prepare_velocity_hessian(dvi__evaluator *e, dvi__derivatives most);
dvi_status dvi__search_velocity(dvi__evaluator *e, double t, const double *q, const double *p,
                                double *v);
dvi_status dvi__velocity_hessian_is_regular(dvi__evaluator *e, double t, const double *q,
                                            const double *v);

#endif
