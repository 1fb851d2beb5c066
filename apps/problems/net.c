/* A net of unit masses and springs in the plane or in space, V = k/2 sum (|d| - 0.8)^2. d is the
 * difference of the places of two neighbours, and the Hessian has the graph of a mesh.
 *
 * The masses rest at the points 1, 2, .. side of a grid of spacing 1 in each of `dim` directions.
 * Those at the border hang on walls at 0 and side + 1. q are the displacements. The springs are
 * stretched at rest, so that the net is stable. */
#include <limits.h>
#include <math.h>

#include "entry.h"

enum { NET_DIMENSIONS = 3 };
static const double net_rest_length = 0.8;

/* A spring from one mass to the next along an axis, or to the wall. */
typedef struct net_spring {
  int from, to; /* masses, and to = -1 for the wall */
  int axis;
  double step; /* direction along the axis, 1 or -1 */
  /* entry at which the rows of mass `to` begin in a column of `from`, and so on */
  int from_in_from, to_in_from, from_in_to, to_in_to;
} net_spring;

typedef struct net {
  int dim, side, masses, springs;
  double k;
  int *start, *row; /* pattern of the Hessian */
  net_spring *spring;
} net;

/* ---- one spring, at up to PROBLEM_TILE points of a batch ---- */

/* A spring's difference vectors and lengths. */
typedef struct net_stretch {
  double d[NET_DIMENSIONS][PROBLEM_TILE], length[PROBLEM_TILE];
} net_stretch;

/* Measure a spring. q begins at the tile's first point, `count` is that of the whole batch, and
 * `tile` the number of points. */
PROBLEM_INLINE void net_measure(const net *own, const net_spring *spring, size_t count, int tile,
                                const double *restrict q, net_stretch *restrict out)
{
  const int dim = own->dim;
  for (int k = 0; k < tile; k++) out->length[k] = 0.0;
  for (int c = 0; c < dim; c++) {
    const double apart = c == spring->axis ? spring->step : 0.0;
    const double *from = q + (size_t)(spring->from * dim + c) * count;
    const double *to = spring->to >= 0 ? q + (size_t)(spring->to * dim + c) * count : from;
    double *d = out->d[c];
    if (spring->to >= 0)
      for (int k = 0; k < tile; k++) d[k] = apart + (to[k] - from[k]);
    else
      for (int k = 0; k < tile; k++) d[k] = apart - from[k];
    for (int k = 0; k < tile; k++) out->length[k] += d[k] * d[k];
  }
  for (int k = 0; k < tile; k++) out->length[k] = sqrt(out->length[k]);
}

static int net_tile(int count, int first)
{
  return count - first < PROBLEM_TILE ? count - first : PROBLEM_TILE;
}

PROBLEM_LANES static int net_value(int count, const double *t, const double *q, double *V,
                                   void *user)
{
  const net *own = user;
  net_stretch s;
  (void)t;
  for (int first = 0; first < count; first += PROBLEM_TILE) {
    const int tile = net_tile(count, first);
    for (int k = 0; k < tile; k++) V[first + k] = 0.0;
    for (int i = 0; i < own->springs; i++) {
      net_measure(own, &own->spring[i], (size_t)count, tile, q + first, &s);
      for (int k = 0; k < tile; k++) {
        const double longer = s.length[k] - net_rest_length;
        V[first + k] += 0.5 * own->k * (longer * longer);
      }
    }
  }
  return 0;
}

PROBLEM_INLINE void net_pull(const net *own, const net_spring *spring, size_t count, int tile,
                             const net_stretch *s, double *V_q)
{
  const int dim = own->dim;
  double factor[PROBLEM_TILE];
  for (int k = 0; k < tile; k++) factor[k] = own->k * (1.0 - net_rest_length / s->length[k]);
  for (int c = 0; c < dim; c++) {
    double *restrict from = V_q + (size_t)(spring->from * dim + c) * count;
    for (int k = 0; k < tile; k++) from[k] -= factor[k] * s->d[c][k];
    if (spring->to < 0) continue;
    double *restrict to = V_q + (size_t)(spring->to * dim + c) * count;
    for (int k = 0; k < tile; k++) to[k] += factor[k] * s->d[c][k];
  }
}

PROBLEM_LANES static int net_gradient(int count, const double *t, const double *q, double *V_q,
                                      void *user)
{
  const net *own = user;
  net_stretch s;
  (void)t;
  memset(V_q, 0, (size_t)own->masses * (size_t)own->dim * (size_t)count * sizeof *V_q);
  for (int first = 0; first < count; first += PROBLEM_TILE) {
    const int tile = net_tile(count, first);
    for (int i = 0; i < own->springs; i++) {
      net_measure(own, &own->spring[i], (size_t)count, tile, q + first, &s);
      net_pull(own, &own->spring[i], (size_t)count, tile, &s, V_q + first);
    }
  }
  return 0;
}

/* Compute entry (i, j) of the spring's curvature, I (1 - l/|d|) k + d d^T k l/|d|^3 with l the rest
 * length. */
PROBLEM_INLINE void net_curvature(const net *own, const net_stretch *s, int tile, int i, int j,
                                  double *restrict curvature)
{
  for (int k = 0; k < tile; k++) {
    const double ratio = net_rest_length / s->length[k], inverse = 1.0 / s->length[k];
    const double dyad = ratio * (s->d[i][k] * inverse) * (s->d[j][k] * inverse);
    curvature[k] = own->k * ((i == j ? 1.0 - ratio : 0.0) + dyad);
  }
}

PROBLEM_INLINE void net_add(int tile, double sign, const double *curvature, double *V_qq)
{
  for (int k = 0; k < tile; k++) V_qq[k] += sign * curvature[k];
}

PROBLEM_INLINE void net_add_curvature(const net *own, const net_spring *spring, size_t count,
                                      int tile, const net_stretch *s, double *V_qq)
{
  const int dim = own->dim;
  double curvature[PROBLEM_TILE];
  for (int j = 0; j < dim; j++)
    for (int i = 0; i < dim; i++) {
      const int from = own->start[spring->from * dim + j] + i;
      net_curvature(own, s, tile, i, j, curvature);
      net_add(tile, 1.0, curvature, V_qq + (size_t)(from + spring->from_in_from) * count);
      if (spring->to < 0) continue;
      const int to = own->start[spring->to * dim + j] + i;
      net_add(tile, -1.0, curvature, V_qq + (size_t)(from + spring->to_in_from) * count);
      net_add(tile, -1.0, curvature, V_qq + (size_t)(to + spring->from_in_to) * count);
      net_add(tile, 1.0, curvature, V_qq + (size_t)(to + spring->to_in_to) * count);
    }
}

PROBLEM_LANES static int net_hessian(int count, const double *t, const double *q, double *V_qq,
                                     void *user)
{
  const net *own = user;
  net_stretch s;
  (void)t;
  memset(V_qq, 0, (size_t)own->start[own->masses * own->dim] * (size_t)count * sizeof *V_qq);
  for (int first = 0; first < count; first += PROBLEM_TILE) {
    const int tile = net_tile(count, first);
    for (int i = 0; i < own->springs; i++) {
      net_measure(own, &own->spring[i], (size_t)count, tile, q + first, &s);
      net_add_curvature(own, &own->spring[i], (size_t)count, tile, &s, V_qq + first);
    }
  }
  return 0;
}

/* ---- the grid ---- */

static int net_stride(const net *own, int axis)
{
  return axis == 0 ? 1 : axis == 1 ? own->side : own->side * own->side;
}

/* Return the place of a mass along an axis, from 0 to side - 1. */
static int net_place(const net *own, int mass, int axis)
{
  return mass / net_stride(own, axis) % own->side;
}

/* Return the neighbour of a mass one step along an axis, or -1 for the wall. */
static int net_neighbour(const net *own, int mass, int axis, int step)
{
  const int place = net_place(own, mass, axis) + step;
  return place >= 0 && place < own->side ? mass + step * net_stride(own, axis) : -1;
}

/* List the pattern. A column has the rows of its mass and of the neighbours, in order. */
static void net_list_pattern(net *own)
{
  const int dim = own->dim;
  int entries = 0;
  for (int column = 0; column < own->masses * dim; column++) {
    for (int offset = -dim; offset <= dim; offset++) {
      const int step = (offset > 0) - (offset < 0), axis = step * offset - 1;
      const int other = step == 0 ? column / dim : net_neighbour(own, column / dim, axis, step);
      for (int i = 0; i < dim && other >= 0; i++) own->row[entries++] = other * dim + i;
    }
    own->start[column + 1] = entries;
  }
}

/* Return the entry of a column of `other` at which the rows of `mass` begin. */
static int net_block(const net *own, int mass, int other)
{
  const int *row = own->row + own->start[other * own->dim];
  int entry = 0;
  while (row[entry] != mass * own->dim) entry += own->dim;
  return entry;
}

static void net_add_spring(net *own, int from, int axis, int step)
{
  const int to = net_neighbour(own, from, axis, step);
  net_spring *spring = &own->spring[own->springs++];
  *spring = (net_spring){.from = from, .to = to, .axis = axis, .step = step};
  spring->from_in_from = net_block(own, from, from);
  if (to < 0) return;
  spring->to_in_from = net_block(own, to, from);
  spring->from_in_to = net_block(own, from, to);
  spring->to_in_to = net_block(own, to, to);
}

static void net_list_springs(net *own)
{
  for (int mass = 0; mass < own->masses; mass++)
    for (int axis = 0; axis < own->dim; axis++) {
      if (net_place(own, mass, axis) == 0) net_add_spring(own, mass, axis, -1);
      net_add_spring(own, mass, axis, 1);
    }
}

static dvi_status net_create_grid(problem *made, net *own)
{
  const size_t n = (size_t)made->nq, dim = (size_t)own->dim, masses = n / dim;
  /* number of springs from each of two opposite walls */
  const size_t walls = dim * masses / (size_t)own->side;
  own->start = problem_allocate(made, n + 1, sizeof *own->start);
  own->row = problem_allocate(made, n * dim * (2 * dim + 1), sizeof *own->row);
  own->spring = problem_allocate(made, dim * masses + walls, sizeof *own->spring);
  if (own->start == NULL || own->row == NULL || own->spring == NULL) return DVI_NO_MEMORY;
  net_list_pattern(own);
  net_list_springs(own);
  return DVI_OK;
}

/* Start at rest with a smooth bulge along (1, 1/2, 1/2). */
static void net_place_start(const net *own, problem *made)
{
  for (int mass = 0; mass < own->masses; mass++) {
    double bulge = 0.1;
    for (int axis = 0; axis < own->dim; axis++)
      bulge *= sin(3.14159265358979323846 * (1 + net_place(own, mass, axis)) / (own->side + 1.0));
    for (int c = 0; c < own->dim; c++) made->q[mass * own->dim + c] = c == 0 ? bulge : 0.5 * bulge;
  }
}

static void net_label(const net *own, problem *made)
{
  for (int i = 0; i < made->nq; i++)
    problem_label(made, i, "%c_%d", "xyz"[i % own->dim], i / own->dim + 1);
}

static dvi_status net_create(const double *setting, problem *made)
{
  const int dim = (int)setting[0], side = (int)setting[1];
  const double masses = pow(side, dim), entries = masses * dim * dim * (2 * dim + 1);
  if (entries > INT_MAX) return DVI_NO_MEMORY;
  dvi_status status = problem_room(made, (int)masses * dim, sizeof(net));
  if (status != DVI_OK) return status;
  net *own = made->parameters;
  *own = (net){.dim = dim, .side = side, .masses = (int)masses, .k = setting[2]};
  status = net_create_grid(made, own);
  if (status != DVI_OK) return status;
  net_label(own, made);
  net_place_start(own, made);

  const dvi_potential springs = {.name = "springs",
                                 .value_batch = net_value,
                                 .gradient_batch = net_gradient,
                                 .hessian_batch = net_hessian,
                                 .qq = {own->start, own->row},
                                 .user = own};
  return problem_potential_system(made, 1, &springs);
}

static const problem_parameter parameters[] = {
    {.name = "dim",
     .value = 2.0,
     .least = 2.0,
     .most = 3.0,
     .whole = 1,
     .help = "the dimension of the net and of the space, 2 or 3"},
    {.name = "side",
     .value = 4.0,
     .least = 1.0,
     .most = 5000.0,
     .whole = 1,
     .help = "the number of masses along each side, a whole number from 1 to 5000"},
    {.name = "k",
     .value = 1.0,
     .least = 1e-6,
     .most = 1e6,
     .help = "the stiffness of the springs, from 1e-6 to 1e6"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    0.030348484113241651, 0.015258588232888547, 0.048892835827817345, 0.024222789025948752,
    0.04889800275318934,  0.024449331295198183, 0.03034515804715238,  0.015620829551782435,
    0.049191213602471758, 0.024455570619726686, 0.07958405469076707,  0.039498393064138076,
    0.079730780158131037, 0.040083531103808065, 0.04943733048534573,  0.02540818083727267,
    0.04941925798648307,  0.024423403663310271, 0.080163325910795918, 0.040083648265982375,
    0.080300153707655392, 0.040653612045806184, 0.049649806122005223, 0.02534000077875178,
    0.030719467031881307, 0.015190145798149583, 0.049834058025743713, 0.025162566221221452,
    0.049796376190572478, 0.025372932844318272, 0.030677211007662068, 0.015525213598689781,
};
static const double digits_p[] = {
    -0.011624988670351125, -0.0065939001796773908, -0.018168808844582066, -0.010560344130923958,
    -0.01796047687744988,  -0.0099112540973006619, -0.01127529065400776,  -0.0055249415924431607,
    -0.018420788061336655, -0.0095176474191437637, -0.029112940263600881, -0.015241565243376975,
    -0.028628295444313789, -0.014796696379257105,  -0.017609846060172515, -0.0087372921531180137,
    -0.017760868928681239, -0.008688854916958309,  -0.028653896603709077, -0.013336957919884589,
    -0.028146794636761532, -0.012865474522853628,  -0.016980901675729309, -0.0079325882121691546,
    -0.010576727570168875, -0.0052532701065069109, -0.017418869978287507, -0.0074384606501931901,
    -0.017209132980462897, -0.0068150599355828647, -0.010254796014892233, -0.0042143477092161036,
};

const problem_entry problem_entry_net = {
    .name = "net",
    .summary = "masses and springs in the plane or in space; for Hessians of a mesh's graph",
    .parameters = parameters,
    .make = net_create,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.5,
    .order_t_end = 10.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
