/* Contacts that are held closed. While contact k is held, steps are those of the method with the
 * constraint phi_k(t,q) = 0,
 *
 *     d/dt L_v = L_q + F + N G^T,        phi = 0,        N >= 0.
 *
 * A closed contact whose rate is 0 is held where N > 0, and released where N would change its sign
 * (Signorini's condition; Acary and Brogliato 2008, sec. 1.2). The time of a release
 * is an unknown of the step, as that of a hit is. */
#ifndef DVI_INTEGRATOR_HELD_H
#define DVI_INTEGRATOR_HELD_H
#include "integrator/integrator_struct.h"

/* What steps with one set of equations: a stepper and an evaluator of a system. The integrator's
 * own changes places with that of the contact that is held. */
typedef struct dvi__body {
  const dvi_system *system;
  dvi__stepper stepper;
  dvi__evaluator *evaluator;
  double *memory_before;
  size_t learned;
  struct dvi__attempt *first;
} dvi__body;

typedef struct dvi__bodies {
  int held;        /* the contact that is held, or -1 */
  dvi__body *body; /* [contacts] those of contacts that may be held. That of the contact that is
                    * held is the integrator's own */
  double *start;   /* [3 n] q, v and p before a contact is held */
} dvi__bodies;

/* Make the bodies of all contacts that may be held. */
dvi_status dvi__bodies_create(dvi_integrator *integrator);
void dvi__bodies_destroy(dvi_integrator *integrator);

/* Return the largest memory of a stepper. */
size_t dvi__bodies_memory(const dvi_integrator *integrator);

/* Take the equations of the contact, or those without a constraint for -1. No number changes. */
void dvi__bodies_choose(dvi_integrator *integrator, int contact);

/* Return 1 if the integrator may hold a contact. */
int dvi__bodies_may_hold(const dvi_integrator *integrator);

/* Return the contact that is held, or -1. */
int dvi__bodies_held(const dvi_integrator *integrator);

/* Hold a contact at the present state, where it is closed without a rate, if its force presses.
 * `t` is the time to record. *holds becomes 1 then. */
dvi_status dvi__hold(dvi_integrator *integrator, int contact, double t, int *holds);

/* Release the contact that is held. */
dvi_status dvi__let_go(dvi_integrator *integrator);

/* Compute the force N of the contact that is held, at a state with the velocity v, and the size of
 * the forces that it balances, which may be NULL. */
dvi_status dvi__held_force(dvi_integrator *integrator, double t, const double *q, const double *v,
                           double *N, double *size);

/* Find on the path of the last smooth step where N becomes negative. *tau is 1 or more if it does
 * not. `N0` is the force at its start. */
dvi_status dvi__find_release(dvi_integrator *integrator, double N0, double *tau);

/* Replace the last smooth step, of this length, by the one that ends where N = 0. */
dvi_status dvi__locate_release(dvi_integrator *integrator, double tau, double *length);

#endif
