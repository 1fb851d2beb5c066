/* A system known by what its callbacks compute at one state: they cannot be saved, but other
 * parameters change their values. */
#ifndef DVI_METHOD_FINGERPRINT_H
#define DVI_METHOD_FINGERPRINT_H
#include <dvi/integrator.h>

/* A number, or a weighted sum of numbers, and the sum of its summands' sizes, which tells
 * rounding from difference. */
typedef struct dvi__sum {
  double value, size;
} dvi__sum;

/* Of a state. The velocity is the one that p has, sought from the last step as the next step
 * seeks it. */
typedef struct dvi__fingerprint {
  dvi__sum lagrangian;             /* or Hamiltonian */
  dvi__sum forces;                 /* L_q, or -H_q */
  dvi__sum distance;               /* from the constraint */
  dvi__sum monitor, monitor_slope; /* g and g_q, of steps in another time */
} dvi__fingerprint;

/* The integrator's numbers, or those of a file. */
typedef struct dvi__moment {
  double t, last_h;
  const double *q, *p, *last_q, *last_p; /* [n] */
} dvi__moment;

/* All NaN, and the status of a callback, if one fails there. */
dvi_status dvi__fingerprint_take(const dvi_integrator *integrator, const dvi__moment *moment,
                                 dvi__fingerprint *fingerprint);

/* DVI_BAD_FILE with a sentence that says in which number `here` differs from `saved`, to nine
 * digits. */
dvi_status dvi__fingerprint_compare(const dvi__fingerprint *saved, const dvi__fingerprint *here);

#endif
