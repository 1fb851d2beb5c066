/* For fields exp(-iwt) a layer with eps' = eps + i sigma/w, n^2 = eps' mu, takes E and
 * H = E'/(i w mu) along by
 *
 *     ( cos(n w d)              i (mu/n) sin(n w d) )
 *     ( i (n/mu) sin(n w d)     cos(n w d)          ).
 *
 * E = 0 at the first wall. At the end E = 0, or H = 0, or E = H, a wave that goes away (Born and
 * Wolf 1999, sec. 1.6). The defect of that condition is an analytic function of w. */
#include "support/waves/layers.h"

#include <stdlib.h>

#include "support/waves/bessel.h"

static quad_complex defect(int count, const layer *layers, layer_end end, quad_complex w)
{
  quad_complex E = qc(0, 0), H = qc(1, 0);
  for (int i = 0; i < count; i++) {
    const quad_complex loss = qc_divide(qc(0, layers[i].sigma), w),
                       eps = qc(layers[i].eps + loss.re, loss.im),
                       n = qc_sqrt(qc_scale(layers[i].mu, eps)),
                       phase = qc_scale(layers[i].thickness, qc_multiply(n, w)),
                       cosine = qc_cos(phase), sine = qc_multiply(qc(0, 1), qc_sin(phase)),
                       admittance = qc_scale(1 / (quad)layers[i].mu, n), before = E;
    E = qc_add(qc_multiply(cosine, E), qc_divide(qc_multiply(sine, H), admittance));
    H = qc_add(qc_multiply(qc_multiply(sine, admittance), before), qc_multiply(cosine, H));
  }
  return end == LAYER_CONDUCTOR ? E : end == LAYER_MAGNETIC_WALL ? H : qc_subtract(E, H);
}

/* The secant method. */
static int settle(int count, const layer *layers, layer_end end, quad_complex *w)
{
  quad_complex last = *w, now = qc_add(*w, qc(1e-3, -1e-3));
  quad_complex f = defect(count, layers, end, last);
  for (int i = 0; i < 100; i++) {
    const quad_complex g = defect(count, layers, end, now), change = qc_subtract(g, f);
    if (qc_size(change) == 0) break;
    const quad_complex step = qc_divide(qc_multiply(g, qc_subtract(now, last)), change);
    last = now;
    f = g;
    now = qc_subtract(now, step);
    if (qc_size(step) < 1e-28 * qc_size(now)) break;
  }
  const quad left = qc_size(qc_subtract(now, last));
  *w = now;
  return left < 1e-20 * qc_size(now);
}

int layers_mode(int count, const layer *layers, layer_end end, double guess, double *frequency,
                double *decay)
{
  quad_complex w = qc(guess, 0);
  const int settled = settle(count, layers, end, &w);
  *frequency = (double)w.re;
  *decay = (double)-w.im;
  return settled;
}

typedef struct cavity {
  int count;
  const layer *layers;
  layer_end end;
} cavity;

/* The defect is real, or imaginary, for real w. */
static quad defect_without_loss(quad w, const void *user)
{
  const cavity *c = user;
  const quad_complex f = defect(c->count, c->layers, c->end, qc(w, 0));
  return c->end == LAYER_CONDUCTOR ? f.im : f.re;
}

void layers_frequencies(int count, const layer *layers, layer_end end, int most, double *frequency)
{
  const cavity c = {count, layers, end};
  const quad step = 0.01;
  quad *root = calloc((size_t)most, sizeof *root);
  find_roots(defect_without_loss, &c, step / 2, step, most, root);
  for (int i = 0; i < most; i++) frequency[i] = (double)root[i];
  free(root);
}
