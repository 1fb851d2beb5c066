/* Systems with nonholonomic constraints beside those of the catalogue. */
#ifndef SUPPORT_ROLLING_H
#define SUPPORT_ROLLING_H
#include <dvi/dvi.h>

enum { ROLLING_N = 4 };

typedef enum rolling_kind {
  ROLLING_PLATE,  /* a blade with friction on a plate that moves as (0.3 sin 2t, 0) */
  ROLLING_COSINES /* the catalogue's knife edge with (x, y, cos a, sin a), on c^2 + s^2 = 1 */
} rolling_kind;

/* A system with a start at t = 0 and the span of an order study. */
typedef struct rolling {
  const char *name;
  dvi_system *system;
  int n;
  double q[ROLLING_N], v[ROLLING_N], span;
} rolling;

/* `differenced` leaves out the derivatives of the rows. */
void make_rolling(rolling_kind kind, int differenced, rolling *made);
void destroy_rolling(rolling *made);

dvi_integrator *rolling_integrator(const rolling *model, const char *method);

#endif
