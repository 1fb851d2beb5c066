/* Check of the symmetry that periodic ends assume, L(t + T, A q + a, A v) = L(t, q, v), with both
 * gradients. On a path at rest the value alone may agree by chance, because a force that pushes
 * sideways does no work there. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "num/finite.h"
#include "boundary/path_struct.h"

/* A symmetry changes the Lagrangian by less than this part. */
static const double symmetric_below = 1e-8;

/* A comparison of L, L_q and L_v. */
enum { VALUE, FORCE, MOMENTUM, KINDS };
typedef struct comparison {
  double difference[KINDS]; /* largest difference */
  double t[KINDS];          /* time of the largest difference */
  double size[KINDS];       /* largest magnitude */
} comparison;

/* Start a comparison. Roundoff in a path at rest has the size of motions that would cross the
 * path's own size in its span. */
static void comparison_start(dvi_path *path, const double *x, comparison *c)
{
  const double *last = dvi__path_at(path, x, path->steps),
               kinetic = dvi__largest((size_t)path->n, path->kinetic);
  const double size = fmax(dvi__largest((size_t)path->core, x),
                           dvi__largest((size_t)path->n, last));
  const double rate = size / dvi__path_span(path, x);
  *c = (comparison){
      .size = {kinetic * rate * rate, kinetic * rate / dvi__path_span(path, x), kinetic * rate}};
}

static void comparison_add(comparison *c, int kind, double t, int count, const double *here,
                           const double *there)
{
  for (int i = 0; i < count; i++) {
    const double difference = fabs(here[i] - there[i]);
    if (difference > c->difference[kind]) c->t[kind] = t;
    c->difference[kind] = fmax(c->difference[kind], difference);
    c->size[kind] = fmax(c->size[kind], fmax(fabs(here[i]), fabs(there[i])));
  }
}

/* Compare the Lagrangian at node k and at its image under the symmetry. The gradients must obey
 * A^T L_q' = L_q and A^T L_v' = L_v. */
static dvi_status compare_node(dvi_path *path, const double *x, int k, double t, comparison *c)
{
  enum { V, TURNED_V, L_Q, L_V, TURNED_L_Q, TURNED_L_V, BACK, ARRAYS };
  const double span = dvi__path_span(path, x), later = t + span;
  dvi__evaluator *e = dvi__action_evaluator(path->action);
  double *at[ARRAYS], L[2];
  for (int m = 0; m < ARRAYS; m++) at[m] = path->probe + (size_t)m * (size_t)path->n;
  memcpy(at[V], dvi__path_at(path, x, k + 1), (size_t)path->n * sizeof(double));
  const double *q = dvi__path_at(path, x, k);
  for (int i = 0; i < path->n; i++) at[V][i] = (at[V][i] - q[i]) * path->steps / span;
  DVI_TRY(dvi__lagrangian_value(e, 1, &t, q, at[V], &L[0]));
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, at[V], at[L_Q], at[L_V]));
  dvi__path_turn(path, at[V], at[TURNED_V]);
  const double *turned = dvi__path_image(path, q);
  DVI_TRY(dvi__lagrangian_value(e, 1, &later, turned, at[TURNED_V], &L[1]));
  DVI_TRY(
      dvi__lagrangian_gradient(e, 1, &later, turned, at[TURNED_V], at[TURNED_L_Q], at[TURNED_L_V]));
  comparison_add(c, VALUE, t, 1, &L[0], &L[1]);
  dvi__path_turn_back(path, at[TURNED_L_Q], at[BACK]);
  comparison_add(c, FORCE, t, path->n, at[L_Q], at[BACK]);
  dvi__path_turn_back(path, at[TURNED_L_V], at[BACK]);
  comparison_add(c, MOMENTUM, t, path->n, at[L_V], at[BACK]);
  return DVI_OK;
}

static dvi_status comparison_verdict(const dvi_path *path, const comparison *c)
{
  static const char *const names[KINDS] = {"L", "L_q", "L_v"};
  for (int kind = 0; kind < KINDS; kind++)
    if (!(c->difference[kind] <= symmetric_below * c->size[kind]))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "the %s is none of the Lagrangian's: it changes %s by %.3g (of %.3g) at t = "
                       "%.6g; the path is unchanged",
                       path->turn.start != NULL || path->shift != NULL ? "symmetry" : "period",
                       names[kind], c->difference[kind], c->size[kind], c->t[kind]);
  return DVI_OK;
}

dvi_status dvi__path_check_symmetry(dvi_path *path, const double *x, int nodes)
{
  comparison c;
  if (path->ends != DVI_ENDS_PERIODIC) return DVI_OK;
  if (path->system->autonomous && path->turn.start == NULL && path->shift == NULL) return DVI_OK;
  DVI_TRY(dvi__path_scale(path, x));
  comparison_start(path, x, &c);
  const double h = dvi__path_span(path, x) / path->steps;
  for (int k = 0; k < nodes; k++) {
    const dvi_status status = compare_node(path, x, k, path->start + k * h, &c);
    if (status != DVI_OK) return dvi__fail_in(status, "node %d of %d", k, path->steps);
  }
  /* Compare the first node at a second time, because a drive may vanish at the first one. */
  DVI_TRY(compare_node(path, x, 0, path->start + 0.37 * path->steps * h, &c));
  return comparison_verdict(path, &c);
}
