/* Steps that are divided at the hits of contacts. The time of a hit is an unknown of the step. With
 * the length alpha h of a step of the method,
 *
 *     phi(t0 + alpha h, q(alpha h)) = 0,        p+ = p- + lambda G^T,        phi'+ = -e phi'-,
 *
 * and a step of (1 - alpha) h, or what remains of it, follows. For e = 1 the energy in the frame of
 * the wall is kept, H(q,p+) + lambda phi_t = H(q,p-), which is the same where H is of second degree
 * in p. Source: Fetecau, Marsden, Ortiz and West 2003, sec. 3, with the reflection of H instead of
 * that of the discrete energy. */
#ifndef DVI_INTEGRATOR_HITS_H
#define DVI_INTEGRATOR_HITS_H
#include "integrator/integrator_struct.h"
#include "system/term/contact.h"

/* Prepare an integrator of a system with contacts. Others get no memory. */
dvi_status dvi__hits_create(dvi_integrator *integrator);
void dvi__hits_destroy(dvi_integrator *integrator);

/* Refuse a start inside a contact, and forget the last step's hits. */
dvi_status dvi__hits_start(dvi_integrator *integrator, double t, const double *q, const double *v);
void dvi__hits_forget(dvi_integrator *integrator);

/* Return 1 if the driver divides the integrator's steps at hits. */
int dvi__hits_divide(const dvi_integrator *integrator);

/* Take one step that is divided at its hits. A step that fails changes nothing. */
dvi_status dvi__hits_step(dvi_integrator *integrator, double h);

/* Take back the last step, which had hits. */
void dvi__hits_take_back(dvi_integrator *integrator);

/* The length and the first time of the last step, which had hits. */
double dvi__hits_length(const dvi_integrator *integrator);
double dvi__hits_first_time(const dvi_integrator *integrator);

/* Return 1 if t lies before the last hit of the last step. The path there is Hermite's cubic from
 * hit to hit, with the error O(h^4). */
int dvi__hits_before(const dvi_integrator *integrator, double t);
dvi_status dvi__hits_path(const dvi_integrator *integrator, double t, double *q, double *v);

#endif
