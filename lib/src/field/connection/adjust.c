/* Trivial and harmonic connections (Crane, Desbrun and Schroeder 2010, sec. 2 and 3).
 *
 * A 1-form x on the edges turns vectors by x when they cross an edge, seen from its lower to its
 * higher vertex, to the left. Around the nodes, vertices and components of the boundary, these
 * angles sum to d^T x. Of all x with
 *
 *     d^T x = 2 pi index - deficit,     sum of x along a loop = turn - holonomy     (mod 2 pi/N)
 *
 * the sum of x^2/w is least for x = w (d u + sum_i a_i h_i), h_i = z_i - d u_i, where
 *
 *     K u = 2 pi index - deficit,   K u_i = d^T w z_i,   K = d^T w d,
 *
 * and z_i is a closed form that is 1 on the i-th edge that closes a loop, and 0 on the other ones
 * and on the tree of nodes. The weights w = (cot a + cot b)/2 may have signs. K has none, because
 * u.K u is the Dirichlet integral of u. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/definite.h"
#include "field/connection/cell.h"
#include "field/connection/connection.h"
#include "field/connection/surface.h"
#include "num/dense.h"
#include "num/finite.h"

static const double two_pi = 6.28318530717958647693, index_slack = 1e-9;

/* Symmetries that a sentence may name. */
enum { MOST_NAMED = 12 };

/* Holonomies have the roundings of 2 pi times the largest index, times the matrix's condition. */
static const double most_index = 1e4;

typedef struct adjustment {
  const dvi_connection *c;
  const dvi_adjust_options *options;
  int symmetry;
  dvi__surface s;
  int64_t edges;
  double *weight;          /* [edges], 0 on the boundary */
  double *x;               /* [edges] */
  double *right;           /* [nodes] */
  double *u, *rest, *form; /* [nodes], [nodes], [edges] to work with */
  double *harmonic;        /* [loops][edges] w h_i */
  dvi__csr d;              /* [edges][nodes - 1], without node 0 */
  dvi__definite K;
} adjustment;

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "curvature: no memory for directions");
}

/* ---- indices ---- */

/* Refuse two indices of one node. */
static dvi_status check_single(const adjustment *a, int i)
{
  const dvi_singularity *given = a->options->singularity;
  for (int j = 0; j < i; j++)
    if (a->s.node[given[j].vertex] == a->s.node[given[i].vertex])
      return dvi__fail(DVI_BAD_ARGUMENT,
                       given[i].vertex == given[j].vertex
                           ? "curvature: vertices %lld and %lld have indices, and are the same"
                           : "curvature: vertices %lld and %lld have indices, and are on the same "
                             "boundary, which has one index",
                       (long long)given[j].vertex, (long long)given[i].vertex);
  return DVI_OK;
}

static int is_multiple(double index, int symmetry)
{
  const double multiple = index * symmetry;
  return fabs(multiple - nearbyint(multiple)) <= index_slack;
}

static dvi_status refuse_fraction(const dvi_singularity *given, int symmetry)
{
  int other = 1;
  while (other < MOST_NAMED && !is_multiple(given->index, other)) other++;
  if (is_multiple(given->index, other))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "curvature: index %g at vertex %lld is no multiple of 1/%d, as fields of "
                     "symmetry %d have them; fields of symmetry %d have such an index",
                     given->index, (long long)given->vertex, symmetry, symmetry, other);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "curvature: index %g at vertex %lld is no multiple of 1/%d, as fields of "
                   "symmetry %d have them",
                   given->index, (long long)given->vertex, symmetry, symmetry);
}

static dvi_status check_index(const adjustment *a, int i)
{
  const dvi_singularity *given = a->options->singularity + i;
  if (given->vertex < 0 || given->vertex >= a->c->mesh->count[0])
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "curvature: index %g at vertex %lld, and the vertices are 0 to %lld",
                     given->index, (long long)given->vertex, (long long)a->c->mesh->count[0] - 1);
  if (!(fabs(given->index) <= most_index))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "curvature: index %g at vertex %lld, and indices are -%g to %g", given->index,
                     (long long)given->vertex, most_index, most_index);
  return is_multiple(given->index, a->symmetry) ? check_single(a, i)
                                                : refuse_fraction(given, a->symmetry);
}

static dvi_status check_turns(const adjustment *a)
{
  const double *turn = a->options->turn;
  const ptrdiff_t at = turn != NULL ? dvi__first_not_finite((size_t)a->c->loops, turn) : -1;
  if (at < 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "curvature: turn %g along loop %td, and turns are finite",
                   turn[at], at);
}

static dvi_status check_indices(const adjustment *a)
{
  const dvi_mesh *mesh = a->c->mesh;
  const int64_t euler = mesh->count[0] - mesh->count[1] + mesh->count[2];
  double sum = 0;
  for (int i = 0; i < a->options->singularities; i++) {
    DVI_TRY(check_index(a, i));
    sum += a->options->singularity[i].index;
  }
  if (fabs(sum - (double)euler) <= index_slack * (1 + a->options->singularities)) return DVI_OK;
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "curvature: the indices sum to %g, and on this surface they sum to %lld, Euler's "
      "characteristic; a vertex of a boundary stands for the whole boundary",
      sum, (long long)euler);
}

/* Set 2 pi index - deficit of the nodes. */
static dvi_status set_right_side(adjustment *a)
{
  const int64_t vertices = a->c->mesh->count[0];
  double *deficit = DVI_NEW(double, vertices);
  if (deficit == NULL) return no_memory();
  const dvi_status status = dvi_hinge_deficits(a->c->mesh, a->c->length, deficit);
  for (int64_t v = 0; v < vertices && status == DVI_OK; v++) a->right[a->s.node[v]] -= deficit[v];
  for (int i = 0; i < a->options->singularities && status == DVI_OK; i++) {
    const dvi_singularity *given = a->options->singularity + i;
    a->right[a->s.node[given->vertex]] += two_pi * nearbyint(given->index * a->symmetry) /
                                          a->symmetry;
  }
  dvi__release(deficit);
  return status;
}

/* ---- matrices ---- */

static dvi_status set_weights(adjustment *a)
{
  for (int64_t cell = 0; cell < a->c->mesh->count[2]; cell++) {
    dvi__laid_cell laid;
    DVI_TRY(dvi__lay_cell(a->c->mesh, a->c->length, cell, &laid));
    for (int k = 0; k < 3; k++) {
      const double angle = dvi__laid_angle(&laid, (k + 1) % 3, (k + 2) % 3).head;
      a->weight[a->c->mesh->facet[2][3 * cell + k]] += 0.5 * cos(angle) / sin(angle);
    }
  }
  for (int64_t e = 0; e < a->edges; e++)
    if (a->s.role[e] == DVI__EDGE_BOUNDARY) a->weight[e] = 0;
  return DVI_OK;
}

/* Give the ends of an edge among the nodes, the lower one first, and the sign of d at the higher.
 * Returns 0 if both are the same. */
static int ends_of(const adjustment *a, int64_t edge, int end[2], int *sign)
{
  const int *vertex = a->c->mesh->corner[1] + 2 * edge, from = a->s.node[vertex[0]],
            to = a->s.node[vertex[1]];
  end[0] = from < to ? from : to;
  end[1] = from < to ? to : from;
  *sign = from < to ? 1 : -1;
  return from != to;
}

static dvi_status set_incidence(adjustment *a)
{
  int64_t entry = 0;
  DVI_TRY(dvi__csr_allocate(a->edges, a->s.nodes - 1, 2 * a->edges, &a->d));
  for (int64_t e = 0; e < a->edges; e++) {
    int end[2], sign;
    const int count = ends_of(a, e, end, &sign) ? 2 : 0;
    for (int i = 0; i < count; i++) {
      if (end[i] == 0) continue;
      a->d.column[entry] = end[i] - 1;
      a->d.value[entry++] = i == 1 ? sign : -sign;
    }
    a->d.start[e + 1] = entry;
  }
  return DVI_OK;
}

static dvi_status make_matrix(adjustment *a)
{
  dvi__csr K = {0};
  DVI_TRY(set_weights(a));
  if (a->s.nodes < 2) return DVI_OK;
  DVI_TRY(set_incidence(a));
  const dvi_matrix d = dvi__csr_view(&a->d, 0),
                   w = {.rows = a->edges, .columns = a->edges, .width = 1, .value = a->weight};
  DVI_TRY(dvi__csr_square(&d, &w, &K));
  const dvi_matrix view = dvi__csr_view(&K, 1);
  const dvi_status status = dvi__definite_create(&view, 2, &a->K);
  dvi__csr_clear(&K);
  return status;
}

/* ---- the exact part ---- */

/* Add w d u with K u = what x lacks of the nodes' sums, twice, because of roundings. `right` has
 * all nodes, of which node 0 follows from the others. */
static dvi_status add_exact(adjustment *a, const double *right, double *x)
{
  const dvi_matrix d = dvi__csr_view(&a->d, 0);
  if (a->s.nodes < 2) return DVI_OK;
  for (int pass = 0; pass < 2; pass++) {
    dvi_matrix_multiply(&d, 1, x, a->rest);
    for (int64_t i = 0; i + 1 < a->s.nodes; i++)
      a->rest[i] = (right != NULL ? right[i + 1] : 0) - a->rest[i];
    DVI_TRY(dvi__definite_solve(&a->K, a->rest, a->u, NULL));
    dvi_matrix_multiply(&d, 0, a->u, a->form);
    for (int64_t e = 0; e < a->edges; e++) x[e] += a->weight[e] * a->form[e];
  }
  return DVI_OK;
}

/* ---- the harmonic part ---- */

/* Set the closed form of a free edge, whose other values follow from the leaves of the tree of
 * triangles to its root. */
static void close_form(const adjustment *a, int64_t edge, double *z)
{
  const dvi_mesh *mesh = a->c->mesh;
  memset(z, 0, (size_t)a->edges * sizeof *z);
  z[edge] = 1;
  for (int64_t i = mesh->count[2] - 1; i > 0; i--) {
    const int64_t at = 3 * (int64_t)a->s.order[i];
    const int parent = a->s.parent[a->s.order[i]];
    double sum = 0;
    for (int slot = 0; slot < 3; slot++)
      if (slot != parent) sum += mesh->sign[2][at + slot] * z[mesh->facet[2][at + slot]];
    z[mesh->facet[2][at + parent]] = -mesh->sign[2][at + parent] * sum;
  }
}

static dvi_status find_harmonic(adjustment *a)
{
  int64_t loop = 0;
  for (int64_t e = 0; e < a->edges; e++) {
    if (a->s.role[e] != DVI__EDGE_FREE) continue;
    double *h = a->harmonic + a->edges * loop++;
    close_form(a, e, h);
    for (int64_t i = 0; i < a->edges; i++) h[i] *= a->weight[i];
    DVI_TRY(add_exact(a, NULL, h));
  }
  return DVI_OK;
}

/* Sum up a form along a loop, or with NULL the angles of the rotations. */
static double turn_along(const adjustment *a, int64_t loop, const double *x)
{
  const dvi_connection *c = a->c;
  double sum = 0;
  for (int64_t i = c->loop_start[loop]; i + 1 < c->loop_start[loop + 1]; i++) {
    const int cell = c->loop_cell[i], next = c->loop_cell[i + 1];
    int slot = 0;
    while (dvi__cell_behind(c->mesh, cell, slot) != next) slot++;
    const int64_t edge = c->mesh->facet[2][3 * (int64_t)cell + slot];
    const double *R = c->rotation + 4 * edge,
                 angle = x != NULL ? x[edge] * dvi__edge_sense(c->mesh, edge) : atan2(R[2], R[0]);
    sum += c->mesh->coface[2 * edge] == cell ? angle : -angle;
  }
  return sum;
}

/* Add the harmonic forms by which the loops have their turns. */
static dvi_status add_harmonic(adjustment *a, double *matrix, double *part, int *pivot)
{
  const int loops = (int)a->c->loops;
  for (int i = 0; i < loops; i++) {
    const double wanted = a->options->turn != NULL ? a->options->turn[i] : 0;
    part[i] = remainder(wanted - turn_along(a, i, NULL) - turn_along(a, i, a->x),
                        two_pi / a->symmetry);
    for (int j = 0; j < loops; j++)
      matrix[j * loops + i] = turn_along(a, i, a->harmonic + j * a->edges);
  }
  if (!dvi__dense_solve(loops, matrix, pivot, part))
    return dvi__fail(DVI_SINGULAR, "curvature: the harmonic forms of the surface are dependent");
  for (int j = 0; j < loops; j++)
    for (int64_t e = 0; e < a->edges; e++) a->x[e] += part[j] * a->harmonic[j * a->edges + e];
  return DVI_OK;
}

static dvi_status adjust_loops(adjustment *a)
{
  const int64_t loops = a->c->loops;
  if (loops == 0 || a->options->is_least) return DVI_OK;
  a->harmonic = DVI_NEW(double, loops * a->edges);
  double *matrix = DVI_NEW(double, loops *(loops + 1));
  int *pivot = DVI_NEW(int, loops);
  dvi_status status = a->harmonic != NULL && matrix != NULL && pivot != NULL ? find_harmonic(a)
                                                                             : no_memory();
  if (status == DVI_OK) status = add_harmonic(a, matrix, matrix + loops * loops, pivot);
  dvi__release(matrix);
  dvi__release(pivot);
  return status;
}

/* ---- all ---- */

static dvi_status solve(adjustment *a)
{
  a->edges = a->c->mesh->count[1];
  DVI_TRY(dvi__surface_create(a->c->mesh, 0, &a->s));
  DVI_TRY(check_indices(a));
  DVI_TRY(check_turns(a));
  a->weight = DVI_NEW(double, 3 * a->edges);
  a->right = DVI_NEW(double, 3 * a->s.nodes);
  if (a->weight == NULL || a->right == NULL) return no_memory();
  a->x = a->weight + a->edges;
  a->form = a->x + a->edges;
  a->u = a->right + a->s.nodes;
  a->rest = a->u + a->s.nodes;
  DVI_TRY(set_right_side(a));
  DVI_TRY(make_matrix(a));
  DVI_TRY(add_exact(a, a->right, a->x));
  return adjust_loops(a);
}

static void turn_rotations(const adjustment *a, dvi_connection *c)
{
  for (int64_t e = 0; e < a->edges; e++) {
    if (c->mesh->coface[2 * e + 1] < 0) continue;
    const double angle = a->x[e] * dvi__edge_sense(c->mesh, e), cosine = cos(angle),
                 sine = sin(angle), turn[4] = {cosine, -sine, sine, cosine};
    dvi__rotation_times(2, turn, a->c->rotation + 4 * e, c->rotation + 4 * e);
  }
  c->is_own = 1;
}

static dvi_status check_arguments(const dvi_connection *connection,
                                  const dvi_adjust_options *options)
{
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: options of size %zu, %zu expected",
                     options->size, sizeof *options);
  if (options->symmetry < 0 || options->singularities < 0 ||
      (options->singularities > 0 && options->singularity == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "curvature: %d singularities of fields of %d directions, where none of both "
                     "is negative, and the indices are given",
                     options->singularities, options->symmetry);
  if (connection->is_own)
    return dvi__fail(DVI_UNSUPPORTED,
                     "curvature: the connection has own rotations; adjust Levi and Civita's");
  return dvi__check_surface(connection->mesh);
}

dvi_status dvi_connection_adjust(const dvi_connection *connection,
                                 const dvi_adjust_options *options, dvi_connection **adjusted)
{
  const dvi_adjust_options defaults = {.size = sizeof defaults};
  if (adjusted == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a place for the connection is needed");
  *adjusted = NULL;
  if (connection == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "curvature: a connection is needed");
  if (options == NULL) options = &defaults;
  DVI_TRY(check_arguments(connection, options));
  adjustment a = {.c = connection,
                  .options = options,
                  .symmetry = options->symmetry > 0 ? options->symmetry : 1};
  dvi_status status = solve(&a);
  if (status == DVI_OK) status = dvi__connection_copy(connection, adjusted);
  if (status == DVI_OK) turn_rotations(&a, *adjusted);
  dvi__release(a.weight);
  dvi__release(a.right);
  dvi__release(a.harmonic);
  dvi__csr_clear(&a.d);
  dvi__definite_clear(&a.K);
  dvi__surface_clear(&a.s);
  return status;
}
