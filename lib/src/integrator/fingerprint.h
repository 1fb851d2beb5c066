/* A fingerprint of a system: values of its callbacks at one state. Callbacks cannot be saved, but
 * other parameters change their values. */
#ifndef DVI_INTEGRATOR_FINGERPRINT_H
#define DVI_INTEGRATOR_FINGERPRINT_H
#include <dvi/integrator.h>

/* A number, or a weighted sum of numbers, with the sum of its summands' magnitudes. The magnitude
 * separates rounding from a difference. */
typedef struct dvi__sum {
  double value, size;
} dvi__sum;

/* The fingerprint of a system at a state. The velocity is that of p, found from the last step as in
 * the next step. */
typedef struct dvi__fingerprint {
  dvi__sum lagrangian;       /* Lagrangian or Hamiltonian */
  dvi__sum forces;           /* L_q, or -H_q */
  dvi__sum distance;         /* distance from the constraint */
  dvi__sum monitor;          /* g, for steps in another time */
  dvi__sum monitor_gradient; /* g_q, for steps in another time */
} dvi__fingerprint;

/* Numbers of a state and of the last step, the integrator's or those of a file. */
typedef struct dvi__moment {
  double t, last_h;
  const double *q, *p, *last_q, *last_p; /* [n] */
} dvi__moment;

/* Evaluate the fingerprint at a state. If a callback fails, return its status and set all numbers
 * to NaN. */
dvi_status dvi__fingerprint_take(const dvi_integrator *integrator, const dvi__moment *moment,
                                 dvi__fingerprint *fingerprint);

/* Compare two fingerprints to nine digits. DVI_BAD_FILE, with a sentence that names the first
 * number that differs. */
dvi_status dvi__fingerprint_compare(const dvi__fingerprint *saved, const dvi__fingerprint *here);

#endif
