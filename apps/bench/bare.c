/* With F_j = V_q(q(c_j)), the matrix A of Gauss' method, and the polynomial E F of the last step's
 * forces, continued to the nodes of this one, a step is
 *
 *     q(c_i) = q0 + c_i h p0/m - h^2/m sum_j (A A)_ij F_j,   at first with (A A E) F,
 *     q1 = q0 + h p0/m - h^2/m sum_j b_j (1 - c_j) F_j,   p1 = p0 - h sum_j b_j F_j.
 *
 * Stages are lanes of vectors, as in the library. */
#include "bench/bare.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline))

/* The processor's best instructions, as in the library. The choice is made before gcc's thread
 * sanitizer can watch it. */
#if defined(__x86_64__) && defined(__gnu_linux__) && \
    (!defined(__clang__) || __clang_major__ >= 14) && !defined(__SANITIZE_THREAD__)
#define CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define CLONES
#endif

enum { DEGREE_MAX = 40, CONTINUED_DEGREE = 10, LANES = 8, MOST_ITERATIONS = 60 };

typedef double vector __attribute__((vector_size(LANES * sizeof(double))));
typedef int64_t mask __attribute__((vector_size(LANES * sizeof(double))));

struct bare {
  const problem *scene;
  int n, s, lanes;
  double h;
  double node[DEGREE_MAX], weight[DEGREE_MAX], end[DEGREE_MAX]; /* c, b and b (1 - c) */
  double t[DEGREE_MAX];                                         /* times at the nodes */
  double *stages, *guess;  /* [s*lanes] A A and A A E, by columns */
  double *padded;          /* [lanes] c, and zeros */
  double *factor, *start;  /* [n] -h^2/m and h p0/m */
  double *q, *p;           /* [n] */
  double *Z;               /* [n*lanes] q(c) - q0 */
  double *Q, *F, *another; /* [n*s], Q with room for one vector more; gradient of one potential */
};

/* ---- tables ---- */

typedef long double square[DEGREE_MAX][DEGREE_MAX];

/* Evaluate P_0 to P_count-1 at x. */
static void legendre(int count, long double x, long double *P)
{
  P[0] = 1;
  P[1] = x;
  for (int k = 1; k + 1 < count; k++) P[k + 1] = ((2 * k + 1) * x * P[k] - k * P[k - 1]) / (k + 1);
}

/* Make A, and the matrix E that continues polynomials of few terms by a step. */
static void fill_matrices(int s, const long double *x, const double *weight, square A, square E)
{
  long double P[DEGREE_MAX + 2], here[DEGREE_MAX + 2], beyond[DEGREE_MAX + 2];
  const int terms = s < CONTINUED_DEGREE ? s : CONTINUED_DEGREE;
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) {
      legendre(s + 2, x[j], P);
      legendre(s + 2, x[i], here);
      legendre(s + 2, x[i] + 2, beyond);
      A[i][j] = weight[j] * (x[i] + 1) / 2;
      E[i][j] = weight[j];
      for (int k = 1; k < s; k++) A[i][j] += weight[j] * P[k] * (here[k + 1] - here[k - 1]) / 2;
      for (int k = 1; k < terms; k++) E[i][j] += weight[j] * (2 * k + 1) * P[k] * beyond[k];
    }
}

static void multiply(int s, square left, square right, square product)
{
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) {
      product[i][j] = 0;
      for (int k = 0; k < s; k++) product[i][j] += left[i][k] * right[k][j];
    }
}

static void fill(bare *b, square *room)
{
  long double x[DEGREE_MAX];
  (void)dvi_quadrature(DVI_GAUSS, b->s, b->node, b->weight); /* the degree is in its range */
  for (int j = 0; j < b->s; j++) x[j] = 2 * (long double)b->node[j] - 1;
  fill_matrices(b->s, x, b->weight, room[0], room[1]);
  multiply(b->s, room[0], room[0], room[2]);
  multiply(b->s, room[2], room[1], room[0]);
  for (int j = 0; j < b->s; j++) {
    b->padded[j] = b->node[j];
    b->end[j] = b->weight[j] * (1 - b->node[j]);
    for (int i = 0; i < b->s; i++) {
      b->stages[j * b->lanes + i] = (double)room[2][i][j];
      b->guess[j * b->lanes + i] = (double)room[0][i][j];
    }
  }
}

/* ---- steps ---- */

static void one_by_one(const bare *b, const dvi_potential *of, double *F)
{
  double *q = b->another + b->n * b->s, *V_q = q + b->n;
  for (int j = 0; j < b->s; j++) {
    for (int i = 0; i < b->n; i++) q[i] = b->Q[i * b->s + j];
    (void)of->gradient(b->t[j], q, V_q, of->user);
    for (int i = 0; i < b->n; i++) F[i * b->s + j] = V_q[i];
  }
}

static void evaluate(const bare *b)
{
  const dvi_system_terms *terms = b->scene->terms;
  for (int k = 0; k < terms->potential_count; k++) {
    const dvi_potential *of = &terms->potentials[k];
    double *F = k == 0 ? b->F : b->another;
    if (of->gradient_batch != NULL)
      (void)of->gradient_batch(b->s, b->t, b->Q, F, of->user);
    else
      one_by_one(b, of, F);
    for (int i = 0; i < b->n * b->s && k > 0; i++) b->F[i] += F[i];
  }
}

/* Replace largest by max(largest, |x|), lane by lane. */
INLINE void larger(vector *largest, const vector *x)
{
  const mask magnitude = (mask)*x & INT64_MAX, take = (mask)((vector)magnitude > *largest);
  *largest = (vector)((take & magnitude) | (~take & (mask)*largest));
}

INLINE double largest_of(const vector *x)
{
  double largest = 0;
  for (int l = 0; l < LANES; l++) largest = (*x)[l] > largest ? (*x)[l] : largest;
  return largest;
}

/* Place the nodes by forces. Gives the largest change of an offset, and the largest offset. A row
 * of Q is overrun by what is beyond the last stage, and the next row follows. */
INLINE void place(bare *b, const int s, const int lanes, const double *matrix, double *change,
                  double *largest)
{
  vector moved = {0}, size = {0}, column, c, before;
  for (int i = 0; i < b->n; i++)
    for (int l = 0; l < lanes; l += LANES) {
      vector sum[4] = {{0}, {0}, {0}, {0}};
      for (int j = 0; j < s; j++) {
        memcpy(&column, matrix + j * lanes + l, sizeof column);
        sum[j % 4] += column * b->F[i * s + j];
      }
      memcpy(&c, b->padded + l, sizeof c);
      memcpy(&before, b->Z + i * lanes + l, sizeof before);
      const vector next = b->start[i] * c + b->factor[i] * ((sum[0] + sum[1]) + (sum[2] + sum[3]));
      const vector at = b->q[i] + next, difference = before - next;
      larger(&moved, &difference);
      larger(&size, &next);
      memcpy(b->Z + i * lanes + l, &next, sizeof next);
      memcpy(b->Q + i * s + l, &at, sizeof at);
    }
  *change = largest_of(&moved);
  *largest = largest_of(&size);
}

typedef struct history {
  double last, ratio, contraction, own;
} history;

/* Tell whether the iteration goes on, as in lib/src/solve/progress.c. */
INLINE bool goes_on(history *t, double correction, double unknown, double size)
{
  const double noise = 32 * DBL_EPSILON * (unknown + size);
  const bool measured = t->last > noise, first = t->last == 0, quiet = correction <= noise;
  const bool again = correction >= 0.35 * t->last;
  const double shrinking = first ? 1 : fmin(correction / t->last, 0.45);
  t->last = correction;
  if (measured) {
    t->contraction = shrinking > t->ratio ? shrinking : t->ratio;
    t->ratio = shrinking;
  }
  const double expected = t->contraction == 0 ? shrinking : t->contraction;
  const double own = t->contraction * t->own;
  if (first || t->contraction == 0 || (!quiet && correction > own))
    t->own = correction;
  else
    t->own = own;
  return !quiet || (expected * t->own > DBL_EPSILON / 2048 * unknown &&
                    (first || measured || t->contraction != 0 || !again));
}

/* Solve one step. Returns the number of iterations. */
INLINE int solve(bare *b, const int s, const int lanes)
{
  history t = {0};
  double change, largest, size = 0;
  int iterations = 0;
  for (int i = 0; i < b->n; i++) size = fabs(b->q[i]) > size ? fabs(b->q[i]) : size;
  place(b, s, lanes, b->guess, &change, &largest);
  do {
    evaluate(b);
    place(b, s, lanes, b->stages, &change, &largest);
    iterations++;
  } while (goes_on(&t, change, largest, size) && iterations < MOST_ITERATIONS);
  return iterations;
}

INLINE void advance(bare *b, const int s)
{
  for (int i = 0; i < b->n; i++) {
    double kick = 0, drift = 0;
    for (int j = 0; j < s; j++) kick += b->weight[j] * b->F[i * s + j];
    for (int j = 0; j < s; j++) drift += b->end[j] * b->F[i * s + j];
    b->q[i] += b->start[i] + b->factor[i] * drift;
    b->p[i] -= b->h * kick;
    b->start[i] += b->factor[i] * kick;
  }
}

INLINE long march(bare *b, long steps, const int s, const int lanes)
{
  long iterations = 0;
  for (long k = 0; k < steps; k++) {
    for (int j = 0; j < s; j++) b->t[j] = b->h * ((double)k + b->node[j]);
    iterations += solve(b, s, lanes);
    advance(b, s);
  }
  return iterations * s;
}

/* Common degrees are constants for the compiler. */
CLONES static long march_any(bare *b, long steps)
{
  switch (b->s) {
  case 4: return march(b, steps, 4, LANES);
  case 8: return march(b, steps, 8, LANES);
  case 16: return march(b, steps, 16, 2 * LANES);
  default: return march(b, steps, b->s, b->lanes);
  }
}

/* ---- loops ---- */

int bare_degree(const char *method)
{
  static const char start[] = "galerkin:degree=";
  const size_t length = sizeof start - 1;
  char *end = NULL;
  if (strncmp(method, start, length) != 0) return 0;
  const long degree = strtol(method + length, &end, 10);
  return *end == '\0' && degree >= 1 && degree <= DEGREE_MAX ? (int)degree : 0;
}

bool bare_takes(const problem *scene)
{
  const dvi_system_terms *terms = scene->terms;
  if (terms == NULL || terms->factors != NULL || terms->lagrangian != NULL ||
      terms->one_form != NULL || terms->hamiltonian != NULL || terms->vector_potential != NULL ||
      terms->noise != NULL || terms->force_count > 0 || terms->holonomic_count > 0 ||
      terms->nonholonomic_count > 0 || terms->contact_count > 0 || terms->damping > 0 ||
      terms->mass.values != NULL || terms->potential_count == 0)
    return false;
  for (int k = 0; k < terms->potential_count; k++)
    if (terms->potentials[k].gradient == NULL && terms->potentials[k].gradient_batch == NULL)
      return false;
  return true;
}

static bool allocate(bare *b)
{
  const size_t n = (size_t)b->n, s = (size_t)b->s, lanes = (size_t)b->lanes;
  const size_t count = lanes * (2 * s + 1 + n) + n * (6 + 3 * s) + LANES;
  double *room = calloc(count, sizeof *room);
  if (room == NULL) return false;
  b->stages = room;
  b->guess = b->stages + s * lanes;
  b->padded = b->guess + s * lanes;
  b->Z = b->padded + lanes;
  b->Q = b->Z + n * lanes;
  b->F = b->Q + n * s + LANES;
  b->another = b->F + n * s;
  b->factor = b->another + n * s + 2 * n;
  b->start = b->factor + n;
  b->q = b->start + n;
  b->p = b->q + n;
  return true;
}

bare *bare_create(const problem *scene, int degree, double h)
{
  bare *b = calloc(1, sizeof *b);
  square *room = calloc(3, sizeof *room);
  if (b != NULL) {
    const int lanes = (degree + LANES - 1) / LANES * LANES;
    *b = (bare){.scene = scene, .n = scene->nq, .s = degree, .lanes = lanes, .h = h};
  }
  if (b == NULL || room == NULL || !allocate(b)) {
    free(b);
    b = NULL;
  } else {
    fill(b, room);
  }
  free(room);
  return b;
}

long bare_run(bare *b, long steps, double *q, double *p)
{
  const dvi_mass *mass = &b->scene->terms->mass;
  const size_t size = (size_t)b->n * sizeof(double);
  memcpy(b->q, b->scene->q, size);
  memcpy(b->p, b->scene->p, size);
  memset(b->F, 0, (size_t)b->s * size);
  for (int i = 0; i < b->n; i++) {
    const double inverse = 1 / (mass->diagonal != NULL ? mass->diagonal[i] : mass->scalar);
    b->factor[i] = -b->h * b->h * inverse;
    b->start[i] = b->h * inverse * b->p[i];
  }
  const long evaluations = march_any(b, steps);
  memcpy(q, b->q, size);
  memcpy(p, b->p, size);
  return evaluations;
}

void bare_destroy(bare *b)
{
  if (b != NULL) free(b->stages);
  free(b);
}
