/* Kinds of dynamics: what the equations of motion of a system are.
 *
 * Each kind is one const struct in a file of its own, listed in system/declare/dynamics.def. The
 * driver, checkpoints, invariants, diagnostics and judges call these functions and ask no kind by
 * name. What a method can use is asked by the bits of dvi__term. */
#ifndef DVI_SYSTEM_EVALUATE_DYNAMICS_H
#define DVI_SYSTEM_EVALUATE_DYNAMICS_H
#include "system/evaluate/evaluator.h"

/* In which form the judges of room reference integrate the motion. */
typedef enum dvi__motion_form {
  DVI__EULER_LAGRANGE, /* q' = v, p' = L_q, p = L_v */
  DVI__FIRST_ORDER,    /* Omega(q) q' = H_q, without momenta of their own */
  DVI__HAMILTON,       /* q' = H_p, p' = -H_q, and the forces of constraints phi(q,p) = 0 */
  DVI__LIFTED          /* on rotations and directions, lifted to coordinates of R^n */
} dvi__motion_form;

/* A constraint that every state of the system fulfils: p = alpha(q), or phi(q,p) = 0. */
typedef struct dvi__state_constraint {
  const char *matrix; /* name of the matrix beyond whose singular points no trajectory goes on */

  /* DVI_BAD_ARGUMENT unless the state fulfils the constraint up to rounding. */
  dvi_status (*check)(dvi__evaluator *e, const double *q, const double *p);

  /* Move q and p [n] onto the constraint. */
  dvi_status (*project)(dvi__evaluator *e, double t, double *q, double *p);

  /* The largest violation; and the size that it is measured by. */
  dvi_status (*distance)(dvi__evaluator *e, const double *q, const double *p, double *distance);
  dvi_status (*size)(dvi__evaluator *e, const double *q, const double *p, double *size);

  /* The side of the singular points on which the state lies: the sign of the matrix's Pfaffian, 0
   * at such a point. Always 1 beyond DVI__SIDES_MOST rows, where the sign would cost as much as a
   * step. */
  dvi_status (*side)(dvi__evaluator *e, const double *q, const double *p, int *side);

  /* Whether the trajectory from q seems to end within h at a singular point. v, ahead [n]: room.
   * NULL: not known. */
  int (*ends)(dvi__evaluator *e, double t, const double *q, double h, double *v, double *ahead);
} dvi__state_constraint;

struct dvi__dynamics {
  const char *name;     /* "constant mass" */
  const char *function; /* what the callbacks compute: "Lagrangian" or "Hamiltonian" */
  dvi__motion_form equations;
  int by_momentum;        /* the functions are of (q,p), and p stands where v stands below */
  int searches_velocity;  /* `velocity` is an iteration, and v holds its guess */
  int has_kinetic_energy; /* p.v/2, and forces L_q that change p */
  int on_manifold;        /* q are not coordinates of R^n */
  /* why there are no Taylor coefficients, and the remedy; NULL: terms may have them */
  const char *no_taylor;
  const char *symmetric; /* names of symmetric methods for it, in words; NULL: the usual ones */

  /* Whether the terms declare this kind; check and copy them into the system, with its term
   * bits. */
  int (*is_declared)(const dvi_system_terms *terms);
  dvi_status (*declare)(const dvi_system_terms *terms, dvi_system *system);

  /* The kind's part of an evaluator: e->own, e->velocity. release may be NULL. */
  dvi_status (*prepare)(dvi__evaluator *e, dvi__derivatives most);
  void (*release)(dvi__evaluator *e);

  /* At one state. The velocity v of (t,q,p); unchanged on failure. */
  dvi_status (*velocity)(dvi__evaluator *e, double t, const double *q, const double *p, double *v);
  /* DVI_SINGULAR if no velocity, or no motion, is defined at the state. NULL: always defined. */
  dvi_status (*regular)(dvi__evaluator *e, double t, const double *q, const double *v);
  /* Both rates; v as above; the multipliers of phi(q,p) = 0 if they are not NULL. NULL: the lifted
   * equations have the rates. */
  dvi_status (*motion)(dvi__evaluator *e, double t, const double *q, const double *p, double *v,
                       double *pdot, double *multiplier);
  dvi_status (*energy)(dvi__evaluator *e, double t, const double *q, const double *v,
                       const double *p, double *E);

  /* The function L, and its derivatives L_q [nq] and L_v as momenta [nv], at stored velocities. */
  dvi_status (*value)(dvi__evaluator *e, double t, const double *q, const double *v, double *L);
  dvi_status (*forces)(dvi__evaluator *e, double t, const double *q, const double *v, double *L_q);
  dvi_status (*momentum)(dvi__evaluator *e, double t, const double *q, const double *v, double *p);

  const dvi__state_constraint *constraint; /* NULL: every (q,p) is a state */
};

/* The kinds (system/declare/dynamics.def); the last two stand for systems that the library
 * makes. */
extern const dvi__dynamics dvi__dynamics_charts, dvi__dynamics_constant_mass,
    dvi__dynamics_general_lagrangian, dvi__dynamics_one_form, dvi__dynamics_hamiltonian,
    dvi__dynamics_constrained_hamiltonian, dvi__dynamics_time_transformed;

/* The argument of the system's functions that is not q: p, or v. */
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

/* DVI_SINGULAR, with a sentence. */
dvi_status dvi__lagrangian_is_degenerate(double t);

/* Functions of the general Lagrangian that others build on. */
dvi_status dvi__prepare_velocity_hessian(dvi__evaluator *e, dvi__derivatives most);
dvi_status dvi__search_velocity(dvi__evaluator *e, double t, const double *q, const double *p,
                                double *v);
dvi_status dvi__velocity_hessian_is_regular(dvi__evaluator *e, double t, const double *q,
                                            const double *v);

#endif
