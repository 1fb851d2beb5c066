/* A closed universe whose spatial sections are alike (Collins and Williams 1973).
 *
 * N_3 regular tetrahedra of edges l_0 and l_1 are joined by struts m, and between them are N_3
 * frusta. With d = l_1 - l_0, and s = 1 for struts that are lengths, -1 for proper times,
 *
 *     h^2 = m^2 - 3 s d^2/8                          the height of a frustum,
 *     b^2 = m^2 - s d^2/4,  A = b (l_0 + l_1)/2      its sides, trapezoids on N_1 edges,
 *     k = d/(h sqrt(24)),   phi = artan k or artanh k   the tilt of its walls,
 *     cos theta = (1/3 - s k^2)/(1 + s k^2)          between two walls,
 *     V = h (l_0^3 + l_0^2 l_1 + l_0 l_1^2 + l_1^3) sqrt(2)/48.
 *
 * n frusta are at a trapezoid, and the N_2 triangles of a section have 2 phi of the layer before
 * less 2 phi of the one behind. The layer's action, a discrete Lagrangian, is
 *
 *     S = N_1 A (2 pi - n theta) + s N_2 (sqrt(3)/2) phi (l_1^2 - l_0^2) - Lambda N_3 V.
 *
 * Schlaefli's identity holds for the frustum, so that the changes of angles drop out:
 *
 *     dS/dm   = N_1 (2 pi - n theta) dA/dm - Lambda N_3 dV/dm
 *     dS/dl_0 = N_1 (2 pi - n theta) dA/dl_0 - s N_2 sqrt(3) phi l_0 - Lambda N_3 dV/dl_0.
 *
 * The l_i are stationary, D_2 S(l_{i-1}, l_i) + D_1 S(l_i, l_{i+1}) = 0. The order in m is 2,
 * because S(l_0, l_1) = S(l_1, l_0). */
#include <float.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/regge/regge.h"

static const double pi = 3.14159265358979323846;

enum { ITERATIONS = 60 };

/* The length at rest is about 1/sqrt(Lambda), and its cube may not underflow. */
static const double least_lambda = 1e-100, most_lambda = 1e100;

/* The sections, and the struts. */
typedef struct sections {
  double edges, triangles, tetrahedra, at_edge; /* N_1, N_2, N_3, n */
  double lambda, strut, sign;                   /* sign is s */
} sections;

/* A layer, and the derivatives of what its action is made of. */
typedef struct layer {
  double A, A_0, A_m, A_01; /* by l_0, m, l_0 and l_1 */
  double V_0, V_m, V_01;
  double deficit, deficit_1, phi, phi_1; /* by l_1 */
} layer;

/* ---- one layer ---- */

/* Compute a layer. Returns 0 if there is none, because its height or its walls are not real. */
static int measure(const sections *u, double l0, double l1, layer *y)
{
  const double s = u->sign, m = u->strut, d = l1 - l0, h2 = m * m - 3 * s * d * d / 8,
               b2 = m * m - s * d * d / 4;
  if (!(h2 > 0) || !(b2 > 0) || !(l1 > 0)) return 0;
  const double h = sqrt(h2), b = sqrt(b2), sum = l0 + l1, k = d / (h * sqrt(24)),
               wall = 1 + s * k * k, h_1 = -3 * s * d / (8 * h), b_1 = -s * d / (4 * b);
  if (!(wall > 0)) return 0;
  /* h and b depend on d alone, so that h_0 = -h_1, and h_01 = -h_11 = 3 s m^2/(8 h^3). */
  const double h_01 = 3 * s * m * m / (8 * h2 * h), b_01 = s * m * m / (4 * b2 * b),
               k_1 = m * m / (h2 * h * sqrt(24)),
               cubes = l0 * l0 * l0 + l0 * l0 * l1 + l0 * l1 * l1 + l1 * l1 * l1,
               cubes_0 = 3 * l0 * l0 + 2 * l0 * l1 + l1 * l1,
               cubes_1 = 3 * l1 * l1 + 2 * l0 * l1 + l0 * l0, unit = sqrt(2) / 48;
  *y = (layer){.A = b * sum / 2,
               .A_0 = b / 2 - b_1 * sum / 2,
               .A_m = m * sum / (2 * b),
               .A_01 = b_01 * sum / 2,
               .V_0 = unit * (h * cubes_0 - h_1 * cubes),
               .V_m = unit * m / h * cubes,
               .V_01 = unit * (h_1 * cubes_0 + 2 * h * sum - h_1 * cubes_1 + h_01 * cubes)};
  /* sin theta = sqrt(8 (1 + 3 s k^2))/3/(1 + s k^2) */
  const double sine = sqrt(8 * (1 + 3 * s * k * k)) / 3 / wall,
               cosine = (1.0 / 3 - s * k * k) / wall;
  y->deficit = 2 * pi - u->at_edge * atan2(sine, cosine);
  y->deficit_1 = -u->at_edge * 8 * s * k * k_1 / (3 * wall * wall * sine);
  y->phi = s > 0 ? atan(k) : atanh(k);
  y->phi_1 = k_1 / wall;
  return 1;
}

/* D_1 S, and its derivative by l_1. */
static double first_slope(const sections *u, double l0, const layer *y)
{
  return u->edges * y->deficit * y->A_0 - u->sign * u->triangles * sqrt(3) * y->phi * l0 -
         u->lambda * u->tetrahedra * y->V_0;
}

static double mixed_bend(const sections *u, double l0, const layer *y)
{
  return u->edges * (y->deficit * y->A_01 + y->deficit_1 * y->A_0) -
         u->sign * u->triangles * sqrt(3) * y->phi_1 * l0 - u->lambda * u->tetrahedra * y->V_01;
}

/* Find l_1 with -D_1 S(l_0, l_1) = p, from the guess in *l1, by Newton's method. Returns 0 if there
 * is none near. */
static int advance(const sections *u, double l0, double p, double *l1)
{
  layer y;
  double before = INFINITY;
  for (int i = 0; i < ITERATIONS; i++) {
    if (!measure(u, l0, *l1, &y)) return 0;
    const double step = (p + first_slope(u, l0, &y)) / mixed_bend(u, l0, &y);
    if (!isfinite(step)) return 0;
    if (fabs(step) <= 8 * DBL_EPSILON * l0 && !(fabs(step) < 0.5 * before)) return 1;
    *l1 -= step;
    before = fabs(step);
  }
  return 0;
}

/* ---- the universe ---- */

static dvi_status check(const dvi_regge *r, const dvi_regge_universe_options *options)
{
  if (options == NULL || options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "regge: options are needed, with size sizeof(dvi_regge_universe_options)");
  if (!(options->strut > 0) || !isfinite(options->strut))
    return dvi__fail(DVI_BAD_ARGUMENT, "regge: struts of length %g are asked, and must be above 0",
                     options->strut);
  if (options->steps < 1)
    return dvi__fail(DVI_BAD_ARGUMENT, "regge: %d steps are asked, 1 or more are possible",
                     options->steps);
  if (!(r->lambda >= least_lambda && r->lambda <= most_lambda))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "regge: Lambda is %g, and an empty universe with a moment of rest needs one "
                     "above 0, of %g to %g",
                     r->lambda, least_lambda, most_lambda);
  if (r->n != 3 || r->boundary_hinges > 0)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "regge: the sections of a universe are closed complexes of tetrahedra, such as "
        "cell-600");
  return DVI_OK;
}

/* Require as many tetrahedra at each edge. count [edges] is work. */
static dvi_status compare_edges(const dvi_regge *r, const sections *u, int *count)
{
  for (int64_t i = 0; i < r->cells * r->pairs; i++) count[r->edge[i]]++;
  for (int64_t e = 0; e < r->edges; e++) {
    if (count[e] == u->at_edge) continue;
    const dvi__cell_name name = dvi__name_cell(r->mesh, 1, e);
    return dvi__fail(
        DVI_UNSUPPORTED,
        "regge: %s has %d tetrahedra, and edges have %.6g in the mean: the sections of "
        "a universe are alike everywhere, such as simplex-4, cell-16, cell-600",
        name.text, count[e], u->at_edge);
  }
  return DVI_OK;
}

static dvi_status count_sections(const dvi_regge *r, sections *u)
{
  u->edges = (double)r->edges;
  u->triangles = (double)r->mesh->count[2];
  u->tetrahedra = (double)r->cells;
  u->at_edge = 6 * u->tetrahedra / u->edges;
  int *count = DVI_NEW(int, r->edges);
  if (count == NULL) return dvi__fail(DVI_NO_MEMORY, "regge: no memory for a universe");
  const dvi_status status = compare_edges(r, u, count);
  dvi__release(count);
  return status;
}

/* Give l_0. At rest the constraint is N_1 (2 pi - n arccos(1/3)) l = Lambda N_3 l^3 sqrt(2)/12. */
static double length_at_rest(const sections *u)
{
  return sqrt(u->edges * (2 * pi - u->at_edge * acos(1.0 / 3)) /
              (u->lambda * u->tetrahedra * sqrt(2) / 12));
}

static dvi_status refuse_layer(const sections *u, int i, double length)
{
  return dvi__fail(
      DVI_STEP_TOO_LARGE,
      "regge: layer %d, from sections of length %.6g on, does not exist with struts of "
      "length %g: the universe ends there, or shorter struts are needed",
      i, length, u->strut);
}

static dvi_status march(const sections *u, int steps, double *length, double *constraint)
{
  double p = 0;
  layer y;
  for (int i = 0; i < steps; i++) {
    double next = i > 0 ? 2 * length[i] - length[i - 1] : length[0];
    if (!advance(u, length[i], p, &next)) return refuse_layer(u, i, length[i]);
    length[i + 1] = next;
    if (!measure(u, next, length[i], &y)) return refuse_layer(u, i, length[i]);
    if (constraint != NULL)
      constraint[i] = u->edges * y.deficit * y.A_m / (u->lambda * u->tetrahedra * y.V_m) - 1;
    p = first_slope(u, next, &y);
  }
  return DVI_OK;
}

dvi_status dvi_regge_universe(const dvi_regge *regge, const dvi_regge_universe_options *options,
                              double *length, double *constraint)
{
  DVI_TRY(dvi__regge_check(regge, length));
  DVI_TRY(check(regge, options));
  sections u = {
      .lambda = regge->lambda, .strut = options->strut, .sign = options->euclidean ? 1 : -1};
  DVI_TRY(count_sections(regge, &u));
  for (int i = 0; i <= options->steps; i++) length[i] = 0;
  for (int i = 0; i < options->steps && constraint != NULL; i++) constraint[i] = 0;
  length[0] = length_at_rest(&u);
  return march(&u, options->steps, length, constraint);
}
