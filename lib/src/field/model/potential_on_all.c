/* Potentials of B on shares. K is semidefinite, and the equations have
 *
 *     A_{i+1} = A_i - (K + alpha M)^-1 (K A_i - d^T M_{k+1} B)
 *
 * as Newton's corrections. A small alpha makes the matrix definite, and slows the corrections down
 * by alpha / (alpha + lambda) with the smallest eigenvalue lambda that is not 0. Corrections have
 * no charge but by roundings, which alpha makes larger: gradients are taken away at the end.
 *
 * The gradient of phi that has the charge of a form A solves d^T M d phi = d^T M A on the vertices
 * of which all edges are unknowns. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "field/model/on_all.h"
#include "field/model/vector_potential.h"

/* alpha beside the largest eigenvalue. */
static const double small = 1e-8;

static const double roundoff = 16 * DBL_EPSILON; /* of d^T H, beside H */

/* Give the norm of a form, or of its values at some cells, of all processes. */
static dvi_status measure(const dvi_mesh *mesh, int k, int64_t count, const int *cell,
                          const double *form, double *norm)
{
  dvi__accumulator sum = {.terms = 0};
  for (int64_t i = 0; i < count; i++)
    if (dvi__owns(mesh, k, cell != NULL ? cell[i] : i)) dvi__accumulate(&sum, form[i] * form[i]);
  DVI_TRY(dvi__sum_of_all(mesh, &sum, norm));
  *norm = sqrt(*norm);
  return DVI_OK;
}

static dvi_status residual(void *of, const double *x, double *r)
{
  dvi__inverse *v = of;
  const dvi_field *f = v->field;
  memset(v->curl, 0, (size_t)f->cells * sizeof *v->curl);
  for (int64_t i = 0; i < f->unknowns; i++) v->curl[f->unknown[i]] = x[i];
  dvi_matrix_multiply(&v->d, 0, v->curl, v->H);
  for (int64_t b = 0; b < v->d.rows; b++) v->H[b] = v->M.value[b] * (v->H[b] - v->B[b]);
  dvi_matrix_multiply(&v->d, 1, v->H, v->curl);
  for (int64_t i = 0; i < f->unknowns; i++) r[i] = v->curl[f->unknown[i]];
  return DVI_OK;
}

/* ---- gradients ---- */

/* The free vertices, and the gradients of their functions at the unknowns. */
typedef struct gradients {
  const dvi_field *field;
  int64_t free;
  int *vertex, *number; /* [free], and [vertices] of these, or -1 */
  double *mark;         /* [vertices] */
  dvi__csr G, L;        /* d, and d^T M d */
  double *x;            /* [unknowns] the form */
  double *flow;         /* [unknowns] */
  double *phi, *rest;   /* [free] */
} gradients;

/* Mark the vertices with edges that are held. The owner of a vertex has all of its edges. */
static void mark_held(const gradients *g, const dvi_matrix *d)
{
  for (int64_t e = 0; e < d->rows; e++)
    for (int64_t i = dvi__first_entry(d, e);
         i < dvi__first_entry(d, e + 1) && g->field->number[e] < 0; i++)
      g->mark[d->column[i]] = 1;
}

static dvi_status allocate(gradients *g, const dvi_matrix *d)
{
  g->vertex = DVI_NEW(int, d->columns);
  g->number = DVI_NEW(int, d->columns);
  g->mark = DVI_NEW(double, d->columns);
  if (g->vertex == NULL || g->number == NULL || g->mark == NULL)
    return dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for gradients");
  mark_held(g, d);
  return DVI_OK;
}

static dvi_status make_matrices(gradients *g, const dvi_matrix *d)
{
  const dvi_field *f = g->field;
  const dvi_matrix M = dvi__csr_view(&f->mass, 1);
  for (int64_t v = 0; v < d->columns && g->mark != NULL; v++) {
    g->number[v] = g->mark[v] != 0 ? -1 : (int)g->free;
    if (g->number[v] >= 0) g->vertex[g->free++] = (int)v;
  }
  const dvi__selection inner = {
      .row = f->number, .column = g->number, .rows = f->unknowns, .columns = g->free};
  DVI_TRY(dvi__csr_select(d, &inner, &g->G));
  const dvi_matrix G = dvi__csr_view(&g->G, 0);
  DVI_TRY(dvi__csr_square(&G, &M, &g->L));
  /* Where no edge is held, constants have no gradient: the corrections' matrix is definite. */
  for (int64_t v = 0; v < g->free; v++) g->L.value[dvi__csr_find(&g->L, v, (int)v)] *= 1 + small;
  g->flow = DVI_NEW(double, f->unknowns);
  g->phi = DVI_NEW(double, 2 * g->free);
  g->rest = g->phi != NULL ? g->phi + g->free : NULL;
  return g->flow && g->phi ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for gradients");
}

/* d^T M (d phi - A) */
static dvi_status charge(void *of, const double *phi, double *r)
{
  gradients *g = of;
  const dvi_field *f = g->field;
  const dvi_matrix G = dvi__csr_view(&g->G, 0);
  dvi_matrix_multiply(&G, 0, phi, g->flow);
  for (int64_t i = 0; i < f->unknowns; i++) g->flow[i] = f->mass.value[i] * (g->flow[i] - g->x[i]);
  dvi_matrix_multiply(&G, 1, g->flow, r);
  return DVI_OK;
}

static dvi_status subtract(gradients *g)
{
  const dvi_field *f = g->field;
  double size;
  (void)charge(g, g->phi, g->rest);
  DVI_TRY(measure(f->mesh, f->degree, f->unknowns, f->unknown, g->flow, &size));
  const dvi__elliptic equations = {.share = f->mesh,
                                   .unknowns = g->free,
                                   .cell = g->vertex,
                                   .A = dvi__csr_view(&g->L, 1),
                                   .residual = charge,
                                   .of = g,
                                   .rounding = roundoff * size};
  DVI_TRY(dvi__elliptic_solve_once(&equations, g->phi));
  const dvi_matrix G = dvi__csr_view(&g->G, 0);
  dvi_matrix_multiply(&G, 0, g->phi, g->flow);
  for (int64_t i = 0; i < f->unknowns; i++) g->x[i] -= g->flow[i];
  return DVI_OK;
}

static void clear(gradients *g)
{
  dvi__release(g->vertex);
  dvi__release(g->number);
  dvi__release(g->mark);
  dvi__release(g->flow);
  dvi__release(g->phi);
  dvi__csr_clear(&g->G);
  dvi__csr_clear(&g->L);
}

/* Subtract the gradient that has the charge of x. */
static dvi_status subtract_gradient(const dvi_field *f, double *x)
{
  gradients g = {.field = f, .x = x};
  dvi_matrix d;
  int64_t all;
  dvi_status status = dvi_mesh_incidence(f->mesh, 0, &d);
  if (status == DVI_OK) status = allocate(&g, &d);
  status = dvi__agree(f->mesh, status);
  if (status == DVI_OK) status = dvi__refresh(f->mesh, 0, g.mark);
  if (status == DVI_OK) status = dvi__agree(f->mesh, make_matrices(&g, &d));
  all = g.free;
  if (status == DVI_OK) status = dvi__count_all(f->mesh, 1, &all);
  if (status == DVI_OK && all > 0) status = subtract(&g);
  clear(&g);
  return status;
}

/* ---- means ---- */

/* Subtract the means by M of 0-forms of a component of the mesh, as the kernel has them. */
static dvi_status subtract_mean(const dvi_field *f, int64_t component, double *x)
{
  dvi__accumulator sum = {.terms = 0}, size = {.terms = 0};
  double moment, mass;
  for (int64_t i = 0; i < f->unknowns; i++) {
    if (f->component[i] != component || !dvi__owns(f->mesh, 0, f->unknown[i])) continue;
    dvi__accumulate(&sum, f->mass.value[i] * x[i]);
    dvi__accumulate(&size, f->mass.value[i]);
  }
  DVI_TRY(dvi__sum_of_all(f->mesh, &sum, &moment));
  DVI_TRY(dvi__sum_of_all(f->mesh, &size, &mass));
  for (int64_t i = 0; i < f->unknowns; i++)
    if (f->component[i] == component) x[i] -= moment / mass;
  return DVI_OK;
}

/* ---- both ---- */

dvi_status dvi__potential_on_all(dvi__inverse *inverse)
{
  const dvi_field *f = inverse->field;
  double fastest = 0, size;
  dvi__elliptic_report report;
  if (inverse->M.column != NULL)
    return dvi__refuse_share_but(f->mesh,
                                 "maxwell: a potential of B with a star that is not diagonal",
                                 "the circumcentric star");
  if (f->degree > 0) DVI_TRY(dvi_field_fastest(f, &fastest));
  memset(inverse->x, 0, (size_t)f->unknowns * sizeof *inverse->x);
  (void)residual(inverse, inverse->x, inverse->right);
  DVI_TRY(measure(f->mesh, f->degree + 1, inverse->d.rows, NULL, inverse->H, &size));
  const dvi__field_equations equations = {.field = f,
                                          .mass = small * fastest * fastest,
                                          .stiffness = f->degree > 0,
                                          .residual = residual,
                                          .of = inverse,
                                          .rounding = roundoff * size};
  DVI_TRY(dvi__field_solve_on_all(&equations, inverse->x, &report));
  if (f->degree > 0) return subtract_gradient(f, inverse->x);
  for (int64_t c = 0; c < f->components; c++) DVI_TRY(subtract_mean(f, c, inverse->x));
  return DVI_OK;
}
