/* The axes of a grid: nodes, lengths, ends. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/yee.h"

enum { MOST_CELLS = 1 << 24, DEFAULT_LAYERS = 10, VECTOR = 8 };

static const char name[] = "xyz";

/* ---- checks ---- */

static dvi_status check_nodes(const dvi_yee_axis *terms, int number)
{
  const double *x = terms->node;
  for (int i = 0; i <= terms->cells; i++) {
    if (!isfinite(x[i]))
      return dvi__fail(DVI_NOT_FINITE, "yee: node %d of axis %c is %g", i, name[number], x[i]);
    if (i > 0 && !(x[i] > x[i - 1]))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "yee: nodes of axis %c must ascend, and node %d at %g follows %g",
                       name[number], i, x[i], x[i - 1]);
  }
  return DVI_OK;
}

static dvi_status check_layers(const dvi_yee_end *end, int number)
{
  if (end->layers < 1 || !(end->reflection > 0 && end->reflection < 1) || !(end->kappa >= 1) ||
      !(end->alpha >= 0) || !isfinite(end->kappa) || !isfinite(end->alpha))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "yee: the layers of axis %c have layers = %d, reflection = %g, alpha = %g, "
                     "kappa = %g; they need 1 layer or more, 0 < reflection < 1, alpha >= 0, and "
                     "kappa >= 1",
                     name[number], end->layers, end->reflection, end->alpha, end->kappa);
  return DVI_OK;
}

static dvi_status check_kinds(const dvi_yee_axis *terms, int number)
{
  const dvi_yee_boundary lower = terms->end[0].kind, upper = terms->end[1].kind;
  for (int e = 0; e < 2; e++)
    if (terms->end[e].kind < DVI_YEE_PEC || terms->end[e].kind > DVI_YEE_CPML)
      return dvi__fail(DVI_BAD_ARGUMENT, "yee: axis %c has an end of kind %d, which is none",
                       name[number], (int)terms->end[e].kind);
  const int lower_wraps = lower == DVI_YEE_PERIODIC || lower == DVI_YEE_BLOCH;
  const int upper_wraps = upper == DVI_YEE_PERIODIC || upper == DVI_YEE_BLOCH;
  if ((lower_wraps || upper_wraps) && lower != upper)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "yee: axis %c repeats itself at one end only; make both ends periodic, or "
                     "both of Bloch's kind",
                     name[number]);
  if (lower == DVI_YEE_BLOCH && !isfinite(terms->phase))
    return dvi__fail(DVI_NOT_FINITE, "yee: the phase of axis %c is %g", name[number], terms->phase);
  return DVI_OK;
}

static dvi_status check_axis(const dvi_yee_axis *terms, int number)
{
  if (terms->cells < 1 || terms->cells > MOST_CELLS)
    return dvi__fail(DVI_BAD_SIZE, "yee: axis %c has %d boxes, 1 to %d are possible", name[number],
                     terms->cells, MOST_CELLS);
  if (terms->node == NULL) {
    const int is_unit = terms->lower == 0 && terms->upper == 0;
    if (!isfinite(terms->upper - terms->lower) || (!is_unit && !(terms->upper > terms->lower)))
      return dvi__fail(DVI_BAD_ARGUMENT, "yee: axis %c reaches from %g to %g, which is not upwards",
                       name[number], terms->lower, terms->upper);
  } else
    DVI_TRY(check_nodes(terms, number));
  return check_kinds(terms, number);
}

/* ---- lengths ---- */

static size_t padded(int count)
{
  return ((size_t)count + VECTOR - 1) / VECTOR * VECTOR;
}

static dvi_status allocate_axis(dvi__yee_axis *a)
{
  const size_t n = (size_t)a->cells;
  a->node = DVI_NEW(double, n + 1);
  a->length = DVI_NEW(double, n);
  a->dual = DVI_NEW(double, n + 1);
  a->up = DVI_NEW(double, padded(a->cells + 1));
  a->down = DVI_NEW(double, padded(a->cells + 1));
  if (a->node != NULL && a->length != NULL && a->dual != NULL && a->up != NULL && a->down != NULL)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "yee: no memory for an axis of %d boxes", a->cells);
}

/* Equal boxes have equal lengths to the last bit. */
static void set_nodes(dvi__yee_axis *a, const dvi_yee_axis *terms)
{
  const int is_unit = terms->lower == 0 && terms->upper == 0;
  const double upper = is_unit ? 1 : terms->upper, span = upper - terms->lower;
  for (int i = 0; i <= a->cells; i++)
    a->node[i] = terms->node != NULL ? terms->node[i] : terms->lower + span * i / a->cells;
  for (int i = 0; i < a->cells; i++)
    a->length[i] = terms->node != NULL ? a->node[i + 1] - a->node[i] : span / a->cells;
}

static void set_duals(dvi__yee_axis *a)
{
  const int n = a->cells;
  const double around = a->wraps ? a->length[n - 1] : 0;
  a->dual[0] = 0.5 * (around + a->length[0]);
  for (int i = 1; i < n; i++) a->dual[i] = 0.5 * (a->length[i - 1] + a->length[i]);
  a->dual[n] = a->wraps ? a->dual[0] : 0.5 * a->length[n - 1];
}

/* ---- layers ---- */

static void set_defaults(dvi_yee_end *end)
{
  if (end->layers == 0) end->layers = DEFAULT_LAYERS;
  if (end->reflection == 0) end->reflection = 1e-8;
  if (end->kappa == 0) end->kappa = 1;
}

static dvi_status allocate_layers(dvi__yee_axis *a, int e)
{
  dvi__yee_layers *layers = &a->layers[e];
  layers->count = a->end[e].layers;
  layers->width = (int)padded(layers->count);
  layers->first = e == 0 ? 0 : a->cells - layers->count;
  layers->start = e == 0 ? 0 : a->cells - layers->width;
  for (int form = 0; form < 2; form++) {
    layers->b[form] = DVI_NEW(double, layers->width);
    layers->a[form] = DVI_NEW(double, layers->width);
    layers->r[form] = DVI_NEW(double, layers->width);
    layers->up[form] = DVI_NEW(double, layers->width);
    layers->down[form] = DVI_NEW(double, layers->width);
    if (layers->b[form] == NULL || layers->a[form] == NULL || layers->r[form] == NULL ||
        layers->up[form] == NULL || layers->down[form] == NULL)
      return dvi__fail(DVI_NO_MEMORY, "yee: no memory for absorbing layers");
  }
  return DVI_OK;
}

static dvi_status make_layers(dvi__yee_axis *a, int number)
{
  int count = 0;
  for (int e = 0; e < 2; e++) {
    if (a->end[e].kind != DVI_YEE_CPML) continue;
    set_defaults(&a->end[e]);
    DVI_TRY(check_layers(&a->end[e], number));
    if (a->end[e].layers > a->cells - count)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "yee: axis %c has %d boxes, and its absorbing layers take %lld; take more "
                       "boxes, or fewer layers",
                       name[number], a->cells, (long long)count + a->end[e].layers);
    count += a->end[e].layers;
    DVI_TRY(allocate_layers(a, e));
  }
  return DVI_OK;
}

/* Set the factors at a depth (Roden and Gedney 2000, eqs. 7 to 11). */
static void set_factors(dvi__yee_layers *l, int form, int at, const dvi_yee_end *end, double rho,
                        double depth, double dt)
{
  const double most = -2 * log(end->reflection) / depth, s = most * rho * rho * rho,
               kappa = 1 + (end->kappa - 1) * rho * rho * rho, alpha = end->alpha * (1 - rho),
               b = exp(-(s / kappa + alpha) * dt);
  l->b[form][at] = b;
  l->a[form][at] = s > 0 ? s * (b - 1) / (kappa * (s + kappa * alpha)) : 0;
  l->r[form][at] = 1 / kappa - 1;
}

static void set_layers(dvi__yee_axis *a, int e, double dt)
{
  dvi__yee_layers *l = &a->layers[e];
  if (l->count == 0) return;
  const int inner = e == 0 ? l->count : l->first, outer = e == 0 ? 0 : a->cells;
  const double depth = fabs(a->node[outer] - a->node[inner]);
  for (int i = 0; i < l->count; i++) {
    const int cell = l->first + i, at = cell - l->start;
    const double middle = 0.5 * (a->node[cell] + a->node[cell + 1]);
    l->up[0][at] = cell > 0 ? a->up[cell] : 0; /* node 0 is on a conductor */
    l->down[0][at] = cell > 0 ? a->down[cell] : 0;
    l->up[1][at] = l->down[1][at] = dt;
    set_factors(l, 0, at, &a->end[e], fabs(a->node[cell] - a->node[inner]) / depth, depth, dt);
    set_factors(l, 1, at, &a->end[e], fabs(middle - a->node[inner]) / depth, depth, dt);
  }
}

/* ---- axes ---- */

static int is_closed(dvi_yee_boundary kind)
{
  return kind == DVI_YEE_PEC || kind == DVI_YEE_CPML;
}

dvi_status dvi__yee_make_axis(const dvi_yee_axis *terms, int number, dvi__yee_axis *a)
{
  static const dvi_yee_axis trivial = {.cells = 1};
  *a = (dvi__yee_axis){.is_trivial = terms == NULL, .cosine = 1};
  if (terms == NULL) terms = &trivial;
  DVI_TRY(check_axis(terms, number));
  a->cells = terms->cells;
  for (int e = 0; e < 2; e++) a->end[e] = terms->end[e];
  a->wraps = terms->end[0].kind == DVI_YEE_PERIODIC || terms->end[0].kind == DVI_YEE_BLOCH;
  a->nodes = a->is_trivial || a->wraps ? a->cells : a->cells + 1;
  a->free[0] = !a->is_trivial && is_closed(a->end[0].kind);
  a->free[1] = a->nodes - (!a->is_trivial && is_closed(a->end[1].kind));
  if (terms->end[0].kind == DVI_YEE_BLOCH) {
    a->cosine = cos(terms->phase);
    a->sine = sin(terms->phase);
  }
  DVI_TRY(allocate_axis(a));
  set_nodes(a, terms);
  set_duals(a);
  if (a->is_trivial) a->dual[0] = a->dual[1] = 1;
  return make_layers(a, number);
}

void dvi__yee_clear_axis(dvi__yee_axis *a)
{
  for (int e = 0; e < 2; e++)
    for (int form = 0; form < 2; form++) {
      if (form == 0) dvi__release(a->layers[e].psi);
      dvi__release(a->layers[e].b[form]);
      dvi__release(a->layers[e].a[form]);
      dvi__release(a->layers[e].r[form]);
      dvi__release(a->layers[e].up[form]);
      dvi__release(a->layers[e].down[form]);
    }
  dvi__release(a->node);
  dvi__release(a->length);
  dvi__release(a->dual);
  dvi__release(a->up);
  dvi__release(a->down);
}

void dvi__yee_set_step(dvi__yee_axis *a, double dt)
{
  const int n = a->cells;
  a->is_uniform = 1;
  for (int i = 0; i < a->nodes && !a->is_trivial; i++) {
    const int before = i > 0 ? i - 1 : n - 1;
    a->up[i] = i < n ? dt / (a->dual[i] * a->length[i]) : 0;
    a->down[i] = i > 0 || a->wraps ? dt / (a->dual[i] * a->length[before]) : 0;
  }
  for (int i = a->free[0]; i < a->free[1]; i++)
    if (a->up[i] != a->up[a->free[0]] || a->down[i] != a->up[a->free[0]]) a->is_uniform = 0;
  for (int e = 0; e < 2; e++) set_layers(a, e, dt);
}

/* ---- places ---- */

int dvi__yee_locate(const dvi__yee_axis *a, double x, double *part)
{
  int low = 0, high = a->cells - 1;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (a->node[middle] <= x)
      low = middle;
    else
      high = middle - 1;
  }
  *part = a->is_trivial ? 0 : (x - a->node[low]) / a->length[low];
  return low;
}

int dvi__yee_nearest(const dvi__yee_axis *a, double x)
{
  double part;
  const int cell = dvi__yee_locate(a, x, &part);
  return cell + (part > 0.5);
}

int dvi__yee_pieces(const dvi__yee_axis *a, int node, int *cell, double *lower, double *upper)
{
  int count = 0;
  if (a->is_trivial) {
    cell[0] = 0, lower[0] = 0, upper[0] = 1;
    return 1;
  }
  if (node > 0 || a->wraps) {
    const int c = node > 0 ? node - 1 : a->cells - 1;
    cell[count] = c;
    upper[count] = a->node[c + 1];
    lower[count++] = a->node[c + 1] - 0.5 * a->length[c];
  }
  if (node < a->cells) {
    cell[count] = node;
    lower[count] = a->node[node];
    upper[count++] = a->node[node] + 0.5 * a->length[node];
  }
  return count;
}
