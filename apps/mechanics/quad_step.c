/* The path of a step has the velocity sum_k P_k Y_k, k < s, with Legendre's polynomials on [0,1].
 *
 *     q(tau) = q0 + h sum_k I_k(tau) Y_k,   I_k(tau) the integral of P_k from 0,
 *     sum_j b_j ( h (I_k - I_k(1)) L_q + P_k L_v )_j = I_k(1) p0,
 *     q1 = q0 + h Y_0,   p1 = p0 + h sum_j b_j L_q_j
 *
 * (Marsden and West 2001, sec. 2.2.6), with I_k(1) = 0 except for k = 0. The equations are solved
 * by fixed-point iteration with the inverse of K (x) M, K_kl = sum_j b_j P_k P_l. The basis of the
 * library's own path does not matter, because polynomials of that degree are the same space. */
#include "mechanics/quad_step.h"

#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef QUAD_EXISTS
enum { NODES_MAX = 16, DEGREE_MAX = NODES_MAX, ITERATIONS = 400, NEWTON_STEPS = 6 };
/* Relative changes below this one end the iteration once they shrink no more. */
static const double noise = 1e-28;

struct quad_step {
  int n, degree, nodes;
  quad node[NODES_MAX], weight[NODES_MAX];
  quad P[DEGREE_MAX][NODES_MAX], I[DEGREE_MAX][NODES_MAX];
  quad inverse[DEGREE_MAX * DEGREE_MAX];
  quad *Y, *R, *row; /* [degree][n] */
  quad *Q, *V, *L_q, *L_v, *impulse;
  quad *room;
};

/* A rule whose points are the zeros of P_r + one P_(r-1) + two P_(r-2) on [-1,1]. */
typedef struct rule {
  const char *name;
  dvi_rule number;
  int one, two;
} rule;

static const rule rules[] = {{.name = "gauss", .number = DVI_GAUSS},
                             {.name = "lobatto", .number = DVI_LOBATTO, .two = -1},
                             {.name = "radau-left", .number = DVI_RADAU_LEFT, .one = 1},
                             {.name = "radau-right", .number = DVI_RADAU_RIGHT, .one = -1}};

/* Evaluate P_0 .. P_count and their derivatives at x. */
static void legendre(int count, quad x, quad *value, quad *slope)
{
  value[0] = 1, value[1] = x;
  slope[0] = 0, slope[1] = 1;
  for (int k = 1; k < count; k++) {
    value[k + 1] = ((2 * k + 1) * x * value[k] - k * value[k - 1]) / (k + 1);
    slope[k + 1] = slope[k - 1] + (2 * k + 1) * value[k];
  }
}

/* Refine the library's nodes, which are doubles, by Newton's method. */
static bool place_nodes(quad_step *s, const rule *by)
{
  const int r = s->nodes;
  double node[NODES_MAX], weight[NODES_MAX];
  quad value[NODES_MAX + 2], slope[NODES_MAX + 2];
  if (dvi_quadrature(by->number, r, node, weight) != DVI_OK) return false;
  for (int j = 0; j < r; j++) {
    quad x = 2 * (quad)node[j] - 1;
    for (int i = 0; i < NEWTON_STEPS; i++) {
      legendre(r, x, value, slope);
      const quad two = r > 1 ? by->two * value[r - 2] : 0,
                 two_slope = r > 1 ? by->two * slope[r - 2] : 0;
      x -= (value[r] + by->one * value[r - 1] + two) /
           (slope[r] + by->one * slope[r - 1] + two_slope);
    }
    s->node[j] = (1 + x) / 2;
  }
  return true;
}

/* Compute the weights, which integrate P_0 .. P_(r-1) exactly. All integrals but the first are
 * 0. */
static bool weigh_nodes(quad_step *s)
{
  const int r = s->nodes;
  quad A[NODES_MAX * NODES_MAX], inverse[NODES_MAX * NODES_MAX], value[NODES_MAX + 2],
      slope[NODES_MAX + 2];
  for (int j = 0; j < r; j++) {
    legendre(r, 2 * s->node[j] - 1, value, slope);
    for (int k = 0; k < r; k++) A[k * r + j] = value[k];
  }
  if (!quad_invert(r, A, inverse)) return false;
  for (int j = 0; j < r; j++) s->weight[j] = inverse[j * r];
  return true;
}

static bool tabulate_polynomials(quad_step *s)
{
  quad K[DEGREE_MAX * DEGREE_MAX] = {0}, value[DEGREE_MAX + 2], slope[DEGREE_MAX + 2];
  for (int j = 0; j < s->nodes; j++) {
    legendre(s->degree, 2 * s->node[j] - 1, value, slope);
    for (int k = 0; k < s->degree; k++) {
      s->P[k][j] = value[k];
      s->I[k][j] = k == 0 ? s->node[j] : (value[k + 1] - value[k - 1]) / (2 * (2 * k + 1));
    }
    for (int k = 0; k < s->degree; k++)
      for (int l = 0; l < s->degree; l++)
        K[k * s->degree + l] += s->weight[j] * value[k] * value[l];
  }
  return quad_invert(s->degree, K, s->inverse);
}

static const rule *quad_step_read_method(const char *method, int *degree, int *nodes)
{
  char name[32];
  int numbers = 0;
  const char *const degrees = strstr(method, "galerkin:degree="), *const points = strstr(method,
                                                                                         ",nodes=");
  if (degrees != method || points == NULL ||
      sscanf(method, "%*[^,],basis=%*[^,],quadrature=%31[^,],nodes=%n", name, &numbers) != 1)
    return NULL;
  *degree = (int)strtol(method + strlen("galerkin:degree="), NULL, 10);
  *nodes = (int)strtol(points + strlen(",nodes="), NULL, 10);
  if (numbers == 0 || *degree > DEGREE_MAX || *nodes > NODES_MAX) return NULL;
  for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
    if (strcmp(rules[i].name, name) == 0) return &rules[i];
  return NULL;
}

static bool quad_step_allocate(quad_step *s)
{
  const size_t n = (size_t)s->n, block = n * (size_t)s->degree;
  s->room = calloc(3 * block + 5 * n, sizeof *s->room);
  if (s->room == NULL) return false;
  s->Y = s->room;
  s->R = s->Y + block;
  s->row = s->R + block;
  s->Q = s->row + block;
  s->V = s->Q + n;
  s->L_q = s->V + n;
  s->L_v = s->L_q + n;
  s->impulse = s->L_v + n;
  return true;
}

quad_step *quad_step_create(const char *method, int n)
{
  int degree = 0, nodes = 0;
  const rule *by = quad_step_read_method(method, &degree, &nodes);
  quad_step *s = by != NULL ? calloc(1, sizeof *s) : NULL;
  if (s == NULL) return NULL;
  s->n = n;
  s->degree = degree;
  s->nodes = nodes;
  if (!quad_step_allocate(s) || !place_nodes(s, by) || !weigh_nodes(s) || !tabulate_polynomials(s))
    quad_step_destroy(&s);
  return s;
}

void quad_step_destroy(quad_step **step)
{
  if (*step != NULL) free((*step)->room);
  free(*step);
  *step = NULL;
}

/* Add the contribution of quadrature point j to the residual and to the impulse. */
static bool add_node(quad_step *s, quad_motion *motion, quad t, quad h, const quad *q0, int j)
{
  const int n = s->n;
  for (int i = 0; i < n; i++) {
    s->Q[i] = q0[i], s->V[i] = 0;
    for (int k = 0; k < s->degree; k++) {
      s->Q[i] += h * s->I[k][j] * s->Y[k * n + i];
      s->V[i] += s->P[k][j] * s->Y[k * n + i];
    }
  }
  if (!quad_motion_gradient(motion, t + h * s->node[j], s->Q, s->V, s->L_q, s->L_v)) return false;
  for (int i = 0; i < n; i++) {
    s->impulse[i] += h * s->weight[j] * s->L_q[i];
    for (int k = 0; k < s->degree; k++) {
      const quad shift = s->I[k][j] - (k == 0 ? 1 : 0);
      s->R[k * n + i] += s->weight[j] * (h * shift * s->L_q[i] + s->P[k][j] * s->L_v[i]);
    }
  }
  return true;
}

/* Correct Y -= (K (x) M)^-1 R, and return the largest change. */
static double correct_step(quad_step *s, const quad_motion *motion)
{
  const int n = s->n;
  double most = 0.0;
  for (int k = 0; k < s->degree; k++)
    for (int i = 0; i < n; i++) {
      s->row[k * n + i] = 0;
      for (int j = 0; j < n; j++) s->row[k * n + i] += motion->inverse[i * n + j] * s->R[k * n + j];
    }
  for (int k = 0; k < s->degree; k++)
    for (int i = 0; i < n; i++) {
      quad change = 0;
      for (int l = 0; l < s->degree; l++)
        change += s->inverse[k * s->degree + l] * s->row[l * n + i];
      s->Y[k * n + i] -= change;
      most = isnan((double)change) ? HUGE_VAL : fmax(most, fabs((double)change));
    }
  return most;
}

bool quad_step_take(quad_step *s, quad_motion *motion, quad t, quad h, const quad *v, quad *z)
{
  const int n = s->n;
  double last = HUGE_VAL;
  memset(s->Y, 0, (size_t)(s->degree * n) * sizeof *s->Y);
  memcpy(s->Y, v, (size_t)n * sizeof *v);
  for (int iteration = 0; iteration < ITERATIONS; iteration++) {
    memset(s->R, 0, (size_t)(s->degree * n) * sizeof *s->R);
    memset(s->impulse, 0, (size_t)n * sizeof *s->impulse);
    for (int i = 0; i < n; i++) s->R[i] = -z[n + i];
    for (int j = 0; j < s->nodes; j++)
      if (!add_node(s, motion, t, h, z, j)) return false;
    const double change = correct_step(s, motion) /
                          fmax(quad_largest(s->degree * n, s->Y), DBL_MIN);
    if (!isfinite(change)) return false;
    if (change < noise && change >= 0.5 * last) {
      for (int i = 0; i < n; i++) z[i] += h * s->Y[i], z[n + i] += s->impulse[i];
      return true;
    }
    last = change;
  }
  return false;
}
#endif
