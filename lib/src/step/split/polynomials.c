#include "step/split/polynomials.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "step/split/modes.h"
#include "step/split/quadratic.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/compensated.h"
#include "num/stripes.h"

struct dvi__polynomials {
  int n;
  double *mass;       /* [n] */
  double low, high;   /* bounds of omega^2 */
  dvi__stripes G;     /* 4 (M^-1 K - low)/(high - low) */
  double h;           /* length of step of the motion's coefficients (0 before the first) */
  dvi__clenshaw move; /* the two vectors of the motion, also used for one alone */
  double *motion;     /* [4*(DVI__DEGREE_MOST+1)] coefficients */
  struct {
    int degree;
    double *c; /* [DVI__DEGREE_MOST+1] */
  } slot[DVI__POLYNOMIALS_SLOTS];
  double *numbers; /* owns all of these, and `room` */
  double *room;    /* [2*DVI__DEGREE_MOST+3] */
  double *vectors; /* [4*2*G.room] vectors of `move` */
  dvi_counters *counters;
};

static dvi_status polynomials_no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "polynomials: no memory");
}

/* ---- the interval ---- */

/* The discs of Gershgorin of column i, divided by its mass, for M^-1 K and for M^-1/2 K M^-1/2. */
typedef struct discs {
  double centre, radius, even_radius;
} discs;

static discs discs_of(const dvi__quadratic *q, const double *mass, int i)
{
  discs d = {0, 0, 0};
  for (int e = q->pattern.start[i]; e < q->pattern.start[i + 1]; e++) {
    const int j = q->pattern.row[e];
    const double size = fabs(q->stiffness[e]);
    if (j == i) d.centre = q->stiffness[e] / mass[i];
    d.radius += j == i ? 0 : size / mass[i];
    d.even_radius += j == i ? 0 : size / sqrt(mass[i]) / sqrt(mass[j]);
  }
  return d;
}

/* Compute the interval. Each end moves by the possible rounding error, except an end at zero. T_k
 * grows to 1 + k^2 delta at a distance of delta of the interval's length. */
static void polynomials_enclose(dvi__polynomials *p, const dvi__quadratic *q)
{
  double low[2] = {0, 0}, high[2] = {0, 0};
  int longest = 0;
  for (int i = 0; i < p->n; i++) {
    const discs d = discs_of(q, p->mass, i);
    low[0] = fmin(low[0], d.centre - d.radius);
    low[1] = fmin(low[1], d.centre - d.even_radius);
    high[0] = fmax(high[0], d.centre + d.radius);
    high[1] = fmax(high[1], d.centre + d.even_radius);
    longest = q->pattern.start[i + 1] - q->pattern.start[i] > longest
                  ? q->pattern.start[i + 1] - q->pattern.start[i]
                  : longest;
  }
  p->low = fmax(low[0], low[1]);
  p->high = fmin(high[0], high[1]);
  const double rounding = 2 * (longest + 4) * DBL_EPSILON * (p->high - p->low);
  p->high += rounding;
  p->low = p->low < -rounding ? p->low - rounding : 0;
  if (p->high == p->low) p->high = 1; /* without springs any bound is valid */
}

/* ---- create ---- */

static dvi_status polynomials_check(const dvi_system *system)
{
  const int row = dvi__pattern_entries(&system->qq) / system->n;
  if (system->mass_diagonal == NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "polynomials: they need a mass with one number for each coordinate");
  for (int i = 0; i < system->n; i++)
    if (!(system->mass_diagonal[i] > 0))
      return dvi__fail(DVI_SINGULAR, "polynomials: the mass of coordinate %d is not positive", i);
  if (row <= DVI__POLYNOMIALS_ROW) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "polynomials: K has %d entries in a row on average, where %d are possible; give "
                   "its pattern if it is sparse",
                   row, (int)DVI__POLYNOMIALS_ROW);
}

static dvi_status fill_matrix(dvi__polynomials *p, const dvi__quadratic *q)
{
  double *scale = DVI_NEW(double, p->n);
  if (scale == NULL) return polynomials_no_memory();
  for (int i = 0; i < p->n; i++) scale[i] = 4 / (p->high - p->low) / p->mass[i];
  const dvi_status status = dvi__stripes_fill(&q->pattern, q->stiffness, scale,
                                              4 * p->low / (p->high - p->low), &p->G);
  dvi__release(scale);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "polynomials");
}

static void hand_out(dvi__polynomials *p)
{
  const size_t terms = DVI__DEGREE_MOST + 1;
  p->motion = p->numbers;
  p->room = p->motion + 4 * terms;
  for (int k = 0; k < DVI__POLYNOMIALS_SLOTS; k++) p->slot[k].c = p->room + (3 + (size_t)k) * terms;
  double *const x = p->vectors;
  p->move = (dvi__clenshaw){.G = &p->G,
                            .lanes = 2,
                            .c = p->motion,
                            .x = x,
                            .d = x + 2 * p->G.room,
                            .b = x + 4 * p->G.room,
                            .other = x + 6 * p->G.room};
}

static dvi_status polynomials_initialise(dvi__polynomials *p, const dvi_system *system,
                                         dvi__evaluator *evaluator, dvi__quadratic *q)
{
  DVI_TRY(polynomials_check(system));
  DVI_TRY(dvi__quadratic_fill(system, evaluator, q));
  p->n = system->n;
  p->mass = dvi__duplicate(system->mass_diagonal, (size_t)p->n, sizeof(double));
  if (p->mass == NULL) return polynomials_no_memory();
  polynomials_enclose(p, q);
  DVI_TRY(fill_matrix(p, q));
  p->numbers = DVI_NEW(double, (7 + (size_t)DVI__POLYNOMIALS_SLOTS) * (DVI__DEGREE_MOST + 1));
  p->vectors = DVI_NEW(double, 8 * p->G.room);
  if (p->numbers == NULL || p->vectors == NULL) return polynomials_no_memory();
  hand_out(p);
  return DVI_OK;
}

dvi_status dvi__polynomials_create(const dvi_system *system, dvi_counters *counters,
                                   dvi__polynomials **polynomials)
{
  dvi__evaluator *evaluator;
  dvi__quadratic quadratic = {.mass = NULL};
  *polynomials = NULL;
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__HESSIANS, counters, &evaluator));
  dvi__polynomials *made = *polynomials = DVI_NEW(dvi__polynomials, 1);
  if (made != NULL) made->counters = counters;
  const dvi_status status = made != NULL
                                ? polynomials_initialise(made, system, evaluator, &quadratic)
                                : polynomials_no_memory();
  dvi__quadratic_clear(&quadratic);
  dvi__evaluator_destroy(&evaluator);
  if (status != DVI_OK) dvi__polynomials_destroy(polynomials);
  return status;
}

void dvi__polynomials_destroy(dvi__polynomials **polynomials)
{
  dvi__polynomials *p = *polynomials;
  if (p == NULL) return;
  dvi__release(p->mass);
  dvi__stripes_clear(&p->G);
  dvi__release(p->numbers);
  dvi__release(p->vectors);
  dvi__release(p);
  *polynomials = NULL;
}

void dvi__polynomials_interval(const dvi__polynomials *p, double *low, double *high)
{
  *low = p->low;
  *high = p->high;
}

/* ---- coefficients ---- */

/* A growing mode takes digits from all others, because the coefficients are as large as its
 * growth. */
static const double growth_most = 9;

/* Truncate at half a rounding. */
static const double tolerance = DBL_EPSILON / 2;

static dvi_status choose_degree(const dvi__polynomials *p, double h, const dvi__growth *growth,
                                int divided, int *degree)
{
  const double x = fabs(h) * sqrt(p->high), growing = fabs(h) * sqrt(-p->low);
  double bound;
  *degree = dvi__expansion_degree(growth, divided, h * h * p->low, h * h * p->high, tolerance,
                                  &bound);
  if (growing > growth_most)
    return dvi__fail(DVI_NOT_CONVERGED,
                     "of omega^2 of fast modes it is only known that it is above %.6g, and "
                     "exp(%.3g) is too much for polynomials; h = %.3g is possible",
                     p->low, growing, h * growth_most / growing);
  if (*degree < 0)
    return dvi__fail(DVI_NOT_CONVERGED,
                     "h omega = %.6g may be of a fast mode, where this filter does not exist: it "
                     "divides by sinc(h omega), or by its root; h = %.3g is possible",
                     x, 3 * h / x);
  if (*degree <= DVI__DEGREE_MOST) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "h omega = %.6g may be of a fast mode, for which polynomials need the degree "
                   "%d, of %d at most; h = %.3g is possible",
                   x, *degree, (int)DVI__DEGREE_MOST, 0.9 * h * DVI__DEGREE_MOST / *degree);
}

dvi_status dvi__polynomials_expand(dvi__polynomials *p, int slot, double h,
                                   const dvi__growth *growth, int divided,
                                   double (*f)(const void *user, double s), const void *user)
{
  int degree;
  DVI_TRY(choose_degree(p, h, growth, divided, &degree));
  p->slot[slot].degree = degree;
  dvi__expansion_make(degree, h * h * p->low, h * h * p->high, f, user, p->room, p->slot[slot].c,
                      1);
  return DVI_OK;
}

/* The function 1 - cos x grows most of those below. */
static const dvi__growth of_motion = {.type = 1, .mass = 2};

static double expand_sine(const void *user, double s)
{
  double c[4];
  (void)user;
  dvi__modes_functions(s, c);
  return c[1];
}

static double expand_minus_sine(const void *user, double s)
{
  return -expand_sine(user, s);
}

static double minus_fall(const void *user, double s)
{
  double c[4];
  (void)user;
  dvi__modes_functions(s, c);
  return -c[2];
}

static double cosine_less_one(const void *user, double s)
{
  return s * minus_fall(user, s);
}

/* Expand (c_1, -c_2; -s c_2, -c_1), which maps (h M^-1 p, h^2 M^-1 V_q) to the changes of q and of
 * h M^-1 p. */
static dvi_status polynomials_prepare(dvi__polynomials *p, double h)
{
  double (*const f[])(const void *, double) = {expand_sine, minus_fall, cosine_less_one,
                                               expand_minus_sine};
  p->h = 0;
  DVI_TRY(choose_degree(p, h, &of_motion, 0, &p->move.degree));
  for (int k = 0; k < 4; k++)
    dvi__expansion_make(p->move.degree, h * h * p->low, h * h * p->high, f[k], NULL, p->room,
                        p->motion + k, 4);
  p->h = h;
  return DVI_OK;
}

double dvi__polynomials_longest(const dvi__polynomials *p)
{
  return p->low < 0 ? growth_most / sqrt(-p->low) : HUGE_VAL;
}

int dvi__polynomials_degree(const dvi__polynomials *p, double h, double *bound)
{
  return dvi__expansion_degree(&of_motion, 0, h * h * p->low, h * h * p->high, tolerance, bound);
}

/* ---- products ---- */

static double *polynomials_elements(double *vectors)
{
  return vectors + DVI__STRIPES_MARGIN;
}

void dvi__polynomials_to_coordinates(dvi__polynomials *p, int slot, const double *force, double *x)
{
  const dvi__clenshaw sum = {.G = &p->G,
                             .lanes = 1,
                             .degree = p->slot[slot].degree,
                             .c = p->slot[slot].c,
                             .x = p->vectors,
                             .d = p->move.d,
                             .b = p->move.b,
                             .other = p->move.other};
  double *at = polynomials_elements(p->vectors);
  for (int i = 0; i < p->n; i++) at[i] = force[i] / p->mass[i];
  dvi__stripes_sum(&sum);
  memcpy(x, polynomials_elements(sum.d), (size_t)p->n * sizeof(double));
  p->counters->products += sum.degree;
}

void dvi__polynomials_to_forces(dvi__polynomials *p, int slot, const double *force, double *Mx)
{
  dvi__polynomials_to_coordinates(p, slot, force, Mx);
  for (int i = 0; i < p->n; i++) Mx[i] *= p->mass[i];
}

dvi_status dvi__polynomials_move(dvi__polynomials *p, double h, const double *V_q,
                                 const dvi__phase *phase)
{
  if (p->h != h) DVI_TRY(polynomials_prepare(p, h));
  double *const drift = polynomials_elements(p->vectors), *const pull = drift + p->G.room;
  for (int i = 0; i < p->n; i++) {
    drift[i] = h * phase->p[i] / p->mass[i];
    pull[i] = h * h * V_q[i] / p->mass[i];
  }
  dvi__stripes_sum(&p->move);
  const double *const q_change = polynomials_elements(p->move.d), *const v_change = q_change +
                                                                                    p->G.room;
  for (int i = 0; i < p->n; i++) {
    dvi__add_compensated(phase->q + i, phase->q_compensation + i, q_change[i]);
    dvi__add_compensated(phase->p + i, phase->p_compensation + i, p->mass[i] * v_change[i] / h);
  }
  p->counters->products += 2 * p->move.degree;
  return DVI_OK;
}
