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
} dvi_contact;

/** A hit of a contact within a step. */
typedef struct dvi_hit {
  int contact;    /**< its index (dvi_system_contact_name) */
  double t;       /**< the time */
  double before;  /**< the rate phi' of the gap before the hit */
  double after;   /**< and after it, -e phi' */
  double impulse; /**< the change of p along d phi/dq */
} dvi_hit;

#ifdef __cplusplus
extern "C" {
#endif

/** Return the number of contacts. 0 for NULL. */
int dvi_system_contact_count(const dvi_system *system);

/** Return the name of contact k. NULL if k is out of range. */
const char *dvi_system_contact_name(const dvi_system *system, int k);

/** Return the number of hits in the last step, in the order of time. 0 for NULL, and with methods
 *  that do not find the times of hits (moreau-jean). */
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

#ifdef __cplusplus
}
#endif
#endif
