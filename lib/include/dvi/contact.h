/** Contacts phi(t,q) >= 0 of a system, with restitution and friction, and their hits
 *  (docs/mechanics/contacts.md). */
#ifndef DVI_CONTACT_H
#define DVI_CONTACT_H
#include <dvi/integrator.h>

/** A contact phi(t,q) >= 0, such as a floor below a ball, or a gap between two bodies.
 *
 *  At a hit, phi = 0 and phi' < 0, an impulse P_N along the gradient changes the rate phi' to
 *  -e phi', with the restitution e. With friction tangential impulses P_T of magnitude mu P_N at
 *  most act against the slip T(t,q) v. The callbacks have the one-point shape alone.
 *
 *  Contacts stand beside a mass or a general Lagrangian. dvi_system_create refuses them beside
 *  factors, constraints, a one-form or a Hamiltonian (DVI_UNSUPPORTED), and friction without a
 *  tangent, or another number out of its range (DVI_BAD_ARGUMENT, DVI_BAD_SIZE). */
typedef struct dvi_contact {
  const char *name; /**< copied. Used in messages */
  /** The gap phi. Required. */
  int (*gap)(double t, const double *q, double *phi, void *user);
  /** The gradient d phi/dq in the order of the pattern `gradients`, of n rows and one column.
   *  Required. */
  int (*gradient)(double t, const double *q, double *phi_q, void *user);
  /** The rate d phi/dt at fixed q. Default: the gap does not depend on time. */
  int (*rate)(double t, const double *q, double *phi_t, void *user);
  dvi_pattern gradients;
  double restitution; /**< e, 0 to 1 */
  double friction;    /**< mu, 0 or more */
  /** The tangential map T in the order of the pattern `tangents`, of n rows and `tangent_count`
   *  columns. Column a holds the derivatives of the slip's component a by v. With two columns the
   *  components are those in an orthonormal frame. Required with friction. */
  int (*tangent)(double t, const double *q, double *T, void *user);
  int tangent_count; /**< 1 in the plane, 2 in space, 0 without friction */
  dvi_pattern tangents;
  void *user;
  /** 1: where hits accumulate, or the contact stays closed, hold it as the constraint phi = 0, and
   *  release it where its force would pull (docs/mechanics/contacts.md). Default: refuse the step.
   *  One contact is held at a time. Methods that keep contacts closed themselves (moreau-jean) do
   *  so anyway. */
  int hold;
} dvi_contact;

/** What happens to a contact. */
typedef enum dvi_hit_kind {
  DVI_HIT,    /**< its gap closes, and the rate changes its sign */
  DVI_HOLD,   /**< it stays closed from here on */
  DVI_RELEASE /**< its force, which held it closed, is 0 */
} dvi_hit_kind;

/** A hit of a contact within a step, or the start or the end of a time in which it is held. */
typedef struct dvi_hit {
  int contact;    /**< its index (dvi_system_contact_name) */
  double t;       /**< the time; where hits accumulate, the limit of their times */
  double before;  /**< the rate phi' of the gap before the hit */
  double after;   /**< and after it, -e phi', or 0 */
  double impulse; /**< the change of p along d phi/dq */
  dvi_hit_kind kind;
} dvi_hit;

#ifdef __cplusplus
extern "C" {
#endif

/** Return the number of contacts. 0 for NULL. */
int dvi_system_contact_count(const dvi_system *system);

/** Return the name of contact k. NULL if k is out of range. */
const char *dvi_system_contact_name(const dvi_system *system, int k);

/** Return the number of hits, holds and releases in the last step, in the order of time. 0 for
 *  NULL, and with methods that do not find the times of hits (moreau-jean). */
int dvi_integrator_hit_count(const dvi_integrator *integrator);

/** Return hit i of the last step. Its contact is -1 if there is none. */
dvi_hit dvi_integrator_hit(const dvi_integrator *integrator, int i);

/** Compute the smallest gap phi of all contacts at the present state, without an allocation.
 *
 *  @param[out] gap      the smallest gap
 *  @param[out] contact  its index. May be NULL
 *  @retval DVI_UNSUPPORTED  the system has no contacts
 *  @retval DVI_BAD_STATE    before dvi_integrator_start
 *  @retval (others)         as the gap's callback fails */
dvi_status dvi_integrator_gap(dvi_integrator *integrator, double *gap, int *contact);

/** Return 1 if the integrator holds this contact as a constraint where it stays closed, because the
 *  contact is declared with `hold`, and the method does not keep contacts closed itself. */
int dvi_integrator_may_hold(const dvi_integrator *integrator, int contact);

/** Return the index of the contact that is held closed at the present state. -1 if none is held,
 *  for NULL, and with methods that keep contacts closed themselves (moreau-jean). */
int dvi_integrator_held(const dvi_integrator *integrator);

/** Compute the force N >= 0 of a contact at the present state, without an allocation. The momentum
 *  obeys p' = L_q + F + N d phi/dq. N is 0 unless the contact is held.
 *
 *  @param[in]  contact  its index
 *  @param[out] force    N
 *  @retval DVI_BAD_ARGUMENT  there is no such contact, or it is not declared with `hold`
 *  @retval DVI_UNSUPPORTED   the system has no contacts, or the method keeps contacts closed itself
 *  @retval DVI_BAD_STATE     before dvi_integrator_start
 *  @retval (others)          as the callbacks fail */
dvi_status dvi_integrator_contact_force(dvi_integrator *integrator, int contact, double *force);

#ifdef __cplusplus
}
#endif
#endif
