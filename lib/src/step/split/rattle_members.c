#include "step/split/rattle_members.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/factor.h"
#include "num/simd/lanes.h"
#include "num/supernodal/members_definite.h"
#include "num/simd/wide.h"
#include "system/dynamics/holonomic.h"

/* Beyond so many numbers of a member its own arrays fill vectors. */
enum { COORDINATES_MOST = 64 };

struct dvi__rattle_members {
  const dvi_system *system;
  dvi__rattle_matrix matrix;
  dvi_counters *counters;
  dvi__evaluator *evaluator; /* with counters of its own, because lanes may be left */
  dvi__members_definite *factor;
  int has_rates;
  int width;                            /* members of the matrices that are kept */
  const dvi__holonomic_term *kept_from; /* and their constraints */
  int *member, chosen;                  /* [chosen] members whose callbacks are asked */
  /* [POINTS], [n*POINTS], [entries of rows_q * POINTS] a batch with its results */
  double *times, *points, *results;
  double *q;       /* [n] a place */
  double *q_start; /* [n] of each member: where its matrix is known, at t_start */
  /* All that follows has a number of each member in each row. */
  double *t_start;                   /* [1] NaN where no matrix is known */
  double *phi_q, *moved_q, *values;  /* [entries of rows_q] twice, [entries of the matrix] */
  double *phi_t, *w, *mu;            /* [rows]; w is a correction of the multipliers */
  double *x, *change;                /* [n]; change is q1 - q0 */
  double *moved, *last, *size;       /* [1] as in dvi__rattle_is_settled */
  double *on, *least, *doubt;        /* [1]; on is not 0 for lanes that iterate */
  long *values_taken, *solves, *new; /* [1] numbers of evaluations, solutions and matrices */
  double *numbers;
  long *counts;
};

/* ---- create ---- */

static int has_rates(const dvi_system *s)
{
  for (int k = 0; k < s->holonomic_count; k++)
    if (s->holonomics[k].callbacks.rate != NULL) return 1;
  return 0;
}

static dvi_status members_allocate(dvi__rattle_members *r, size_t capacity)
{
  const size_t n = (size_t)r->system->n, m = (size_t)r->system->row_count,
               entries = (size_t)dvi__pattern_entries(&r->system->rows_q),
               values = (size_t)dvi__pattern_entries(r->matrix.pattern);
  double *at = r->numbers = DVI_NEW(double,
                                    n + (1 + n + m + entries) * DVI_HOLONOMIC_POINTS +
                                        (3 * n + 3 * m + 2 * entries + values + 7) * capacity);
  r->counts = DVI_NEW(long, 3 * capacity);
  r->member = DVI_NEW(int, capacity);
  if (at == NULL || r->counts == NULL || r->member == NULL)
    return dvi__fail(DVI_NO_MEMORY, "verlet: no memory for %zu members", capacity);
  double **const of_members[] = {&r->t_start, &r->moved, &r->last, &r->size,
                                 &r->on,      &r->least, &r->doubt};
  for (int i = 0; i < 7; i++, at += capacity) *of_members[i] = at;
  double **const of_coordinates[] = {&r->q_start, &r->x, &r->change};
  for (int i = 0; i < 3; i++, at += n * capacity) *of_coordinates[i] = at;
  double **const of_constraints[] = {&r->phi_t, &r->w, &r->mu};
  for (int i = 0; i < 3; i++, at += m * capacity) *of_constraints[i] = at;
  r->phi_q = at;
  r->moved_q = r->phi_q + entries * capacity;
  r->values = r->moved_q + entries * capacity;
  r->q = r->values + values * capacity;
  r->times = r->q + n;
  r->points = r->times + DVI_HOLONOMIC_POINTS;
  r->results = r->points + n * DVI_HOLONOMIC_POINTS;
  r->values_taken = r->counts;
  r->solves = r->counts + capacity;
  r->new = r->counts + 2 * capacity;
  return DVI_OK;
}

static dvi_status members_prepare(dvi__rattle_members *r, int capacity)
{
  int order[DVI__MEMBERS_DEFINITE_MOST];
  const dvi__pattern *pattern = r->matrix.pattern;
  DVI_TRY(members_allocate(r, (size_t)capacity));
  DVI_TRY(dvi__evaluator_create(r->system, 1, DVI__GRADIENTS, NULL, &r->evaluator));
  DVI_TRY(dvi__definite_order(pattern, order));
  return dvi__members_definite_create(pattern->columns, pattern->start, pattern->row, order,
                                      capacity, &r->factor);
}

int dvi__rattle_members_pay(const dvi_system *system)
{
  return system->row_count <= DVI__MEMBERS_DEFINITE_MOST && system->n <= COORDINATES_MOST &&
         system->row_count < system->n;
}

dvi_status dvi__rattle_members_create(const dvi_system *system, const dvi__rattle_matrix *matrix,
                                      int capacity, dvi_counters *counters,
                                      dvi__rattle_members **members)
{
  dvi__rattle_members *r = *members = DVI_NEW(dvi__rattle_members, 1);
  if (r == NULL) return dvi__fail(DVI_NO_MEMORY, "verlet: no memory");
  r->system = system;
  r->matrix = *matrix;
  r->counters = counters;
  r->has_rates = has_rates(system);
  const dvi_status status = members_prepare(r, capacity);
  if (status != DVI_OK) dvi__rattle_members_destroy(members);
  return status;
}

void dvi__rattle_members_destroy(dvi__rattle_members **members)
{
  dvi__rattle_members *r = *members;
  if (r == NULL) return;
  dvi__members_definite_destroy(&r->factor);
  dvi__evaluator_destroy(&r->evaluator);
  dvi__release(r->numbers);
  dvi__release(r->counts);
  dvi__release(r->member);
  dvi__release(r);
  *members = NULL;
}

/* ---- loops over members ---- */

/* Set x to the sum of factor w_a times the entries of row a. */
WIDE static void members_pull(const dvi__rattle_members *r, size_t width, const double *entries,
                              const double *w, double factor)
{
  const dvi__pattern *G = &r->system->rows_q;
  memset(r->x, 0, (size_t)r->system->n * width * sizeof(double));
  for (int a = 0; a < G->columns; a++)
    for (int e = G->start[a]; e < G->start[a + 1]; e++) {
      const double *restrict by = w + (size_t)a * width, *restrict entry = entries +
                                                                           (size_t)e * width;
      double *restrict x = r->x + (size_t)G->row[e] * width;
      for (size_t k = 0; k < width; k++) x[k] += factor * by[k] * entry[k];
    }
}

/* Compute G M^-1 and G M^-1 G^T. */
WIDE static void members_multiply(const dvi__rattle_members *r, size_t width)
{
  const dvi__pattern *G = &r->system->rows_q;
  const dvi__rattle_matrix *A = &r->matrix;
  for (int e = 0; e < G->start[G->columns]; e++) {
    const double mass = r->system->mass_diagonal[G->row[e]];
    const double *restrict from = r->phi_q + (size_t)e * width;
    double *restrict to = r->moved_q + (size_t)e * width;
    for (size_t k = 0; k < width; k++) to[k] = from[k] / mass;
  }
  memset(r->values, 0, (size_t)dvi__pattern_entries(A->pattern) * width * sizeof(double));
  for (int e = 0; e < dvi__pattern_entries(A->pattern); e++)
    for (int i = A->first[e]; i < A->first[e + 1]; i++) {
      const double *restrict left = r->phi_q + (size_t)A->left[i] * width, *restrict right =
                                                                               r->moved_q +
                                                                               (size_t)A->right[i] *
                                                                                   width;
      double *restrict sum = r->values + (size_t)e * width;
      for (size_t k = 0; k < width; k++) sum[k] += left[k] * right[k];
    }
}

/* Make changes of h v the coordinates' changes, and find the sizes. */
WIDE static void members_guess(const dvi__rattle_members *r, size_t width, const double *q,
                               const double *p, double h)
{
  double *restrict size = r->size;
  memset(size, 0, width * sizeof *size);
  for (size_t i = 0; i < (size_t)r->system->n; i++) {
    const double mass = r->system->mass_diagonal[i];
    const double *restrict at = q + i * width, *restrict from = p + i * width,
                           *restrict x = r->x + i * width;
    double *restrict change = r->change + i * width;
    for (size_t k = 0; k < width; k++) {
      change[k] = h * (from[k] / mass) - x[k];
      size[k] = fabs(at[k]) > size[k] ? fabs(at[k]) : size[k];
      size[k] = fabs(change[k]) > size[k] ? fabs(change[k]) : size[k];
    }
  }
}

/* Correct the ends and the multipliers of the lanes that are on by w, whose x are known. */
WIDE static void members_correct(const dvi__rattle_members *r, size_t width, double per_step,
                                 double *lambda)
{
  double *restrict moved = r->moved, *restrict last = r->last, *restrict doubt = r->doubt;
  const double *restrict on = r->on;
  memcpy(last, moved, width * sizeof *last);
  memset(moved, 0, width * sizeof *moved);
  memset(doubt, 0, width * sizeof *doubt);
  for (size_t i = 0; i < (size_t)r->system->n; i++) {
    const double *restrict x = r->x + i * width;
    double *restrict change = r->change + i * width;
    for (size_t k = 0; k < width; k++) {
      change[k] = on[k] != 0 ? change[k] - x[k] : change[k];
      moved[k] = fabs(x[k]) > moved[k] ? fabs(x[k]) : moved[k];
    }
  }
  for (size_t a = 0; a < (size_t)r->system->row_count; a++) {
    const double *restrict w = r->w + a * width;
    double *restrict to = lambda + a * width;
    for (size_t k = 0; k < width; k++) {
      to[k] = on[k] != 0 ? to[k] + per_step * w[k] : to[k];
      doubt[k] += 0 * w[k];
    }
  }
}

/* Set w to G v + phi_t for the momenta p + x. */
WIDE static void members_push(const dvi__rattle_members *r, size_t width, const double *p,
                              const double *p_compensation)
{
  const dvi__pattern *G = &r->system->rows_q;
  for (size_t i = 0; i < (size_t)r->system->n; i++) {
    const double mass = r->system->mass_diagonal[i];
    const double *restrict from = p + i * width, *restrict low = p_compensation + i * width;
    double *restrict x = r->x + i * width;
    for (size_t k = 0; k < width; k++) x[k] = (from[k] + (x[k] - low[k])) / mass;
  }
  memcpy(r->w, r->phi_t, (size_t)r->system->row_count * width * sizeof(double));
  for (int a = 0; a < G->columns; a++)
    for (int e = G->start[a]; e < G->start[a + 1]; e++) {
      const double *restrict entry = r->phi_q + (size_t)e * width, *restrict v = r->x +
                                                                                 (size_t)G->row[e] *
                                                                                     width;
      double *restrict sum = r->w + (size_t)a * width;
      for (size_t k = 0; k < width; k++) sum[k] += entry[k] * v[k];
    }
}

/* Add w to the multipliers at the end of the lanes that are on. `moved` and `size` become the
 * largest of both. */
WIDE static void members_correct_end(const dvi__rattle_members *r, size_t width)
{
  double *restrict moved = r->moved, *restrict size = r->size, *restrict doubt = r->doubt;
  const double *restrict on = r->on;
  memset(moved, 0, width * sizeof *moved);
  memset(size, 0, width * sizeof *size);
  memset(doubt, 0, width * sizeof *doubt);
  for (size_t a = 0; a < (size_t)r->system->row_count; a++) {
    const double *restrict w = r->w + a * width;
    double *restrict mu = r->mu + a * width;
    for (size_t k = 0; k < width; k++) {
      mu[k] = on[k] != 0 ? mu[k] + w[k] : mu[k];
      doubt[k] += 0 * w[k];
      moved[k] = fabs(w[k]) > moved[k] ? fabs(w[k]) : moved[k];
      size[k] = fabs(mu[k]) > size[k] ? fabs(mu[k]) : size[k];
    }
  }
}

/* Set x to the places at the end. */
WIDE static void members_place(const dvi__rattle_members *r, size_t numbers,
                               const double *restrict q, const double *restrict q_compensation)
{
  const double *restrict change = r->change;
  double *restrict x = r->x;
  for (size_t i = 0; i < numbers; i++) x[i] = q[i] + (change[i] - q_compensation[i]);
}

/* ---- callbacks ---- */

/* A function of some points, with `rows` results for each, at places q [n*count] of all members and
 * h later than their times. It takes at most so many points. */
typedef struct request {
  dvi_status (*function)(dvi__evaluator *e, int count, const double *t, const double *q,
                         double *result);
  size_t rows;
  int most;
  double h;
  const double *q;
  double *result; /* [rows*count] */
} request;

static void leave(dvi__rattle_members *r, const dvi__rattle_lanes *l, size_t k)
{
  l->left[k] = 1;
  r->on[k] = 0;
  r->t_start[k] = (double)NAN;
}

static dvi_status ask_some(const dvi__rattle_members *r, const dvi__rattle_lanes *l,
                           const request *of, const int *member, int count)
{
  const size_t width = (size_t)l->count, n = (size_t)r->system->n;
  double *at = r->points;
  for (int j = 0; j < count; j++) r->times[j] = l->t[member[j]] + of->h;
  for (size_t i = 0; i < n; i++)
    for (int j = 0; j < count; j++) *at++ = of->q[i * width + (size_t)member[j]];
  DVI_TRY(of->function(r->evaluator, count, r->times, r->points, r->results));
  at = r->results;
  for (size_t i = 0; i < of->rows; i++)
    for (int j = 0; j < count; j++) of->result[i * width + (size_t)member[j]] = *at++;
  return DVI_OK;
}

/* Ask for the members that are chosen. If a batch fails they are asked one by one, and those that
 * fail are left. */
static void ask_chosen(dvi__rattle_members *r, const dvi__rattle_lanes *l, const request *of)
{
  for (int first = 0, count; first < r->chosen; first += count) {
    const int *member = r->member + first;
    count = r->chosen - first < of->most ? r->chosen - first : of->most;
    if (ask_some(r, l, of, member, count) == DVI_OK) continue;
    for (int j = 0; j < count; j++)
      if (ask_some(r, l, of, member + j, 1) != DVI_OK) leave(r, l, (size_t)member[j]);
  }
}

/* Tell whether the gradients at a member's place are known, which they are from now on. */
static int note_place(const dvi__rattle_members *r, const dvi__rattle_lanes *l, size_t k)
{
  const size_t n = (size_t)r->system->n, width = (size_t)l->count;
  double *q_start = r->q_start + k * n;
  int known = r->t_start[k] == l->t[k];
  r->t_start[k] = l->t[k];
  for (size_t i = 0; i < n; i++) r->q[i] = l->q[i * width + k];
  known = known && memcmp(q_start, r->q, n * sizeof *q_start) == 0;
  memcpy(q_start, r->q, n * sizeof *q_start);
  return known;
}

static void evaluate_gradients(dvi__rattle_members *r, const dvi__rattle_lanes *l)
{
  r->chosen = 0;
  for (int k = 0; k < l->count; k++) {
    if (l->left[k] || note_place(r, l, (size_t)k)) continue;
    r->member[r->chosen++] = k;
    r->new[k]++;
  }
  ask_chosen(r, l,
             &(request){.function = dvi__rows_all_gradients,
                        .rows = (size_t)dvi__pattern_entries(&r->system->rows_q),
                        .most = DVI_HOLONOMIC_POINTS,
                        .q = l->q,
                        .result = r->phi_q});
}

/* Factor the matrices at the members' places. */
static void factor_members(dvi__rattle_members *r, const dvi__rattle_lanes *l)
{
  const size_t width = (size_t)l->count;
  const int is_kept = r->width == l->count && r->kept_from == r->system->holonomics;
  for (size_t k = 0; k < width && !is_kept; k++) r->t_start[k] = (double)NAN;
  r->width = l->count;
  r->kept_from = r->system->holonomics;
  evaluate_gradients(r, l);
  if (r->chosen > 0) {
    members_multiply(r, width);
    dvi__members_definite_factor(r->factor, l->count, r->values, r->least);
  }
  for (size_t k = 0; k < width; k++)
    if (!l->left[k] && !(r->least[k] >= DVI__RATTLE_SUSPICIOUS)) leave(r, l, k);
}

/* Evaluate phi at the ends of the lanes that are on, into w. */
static void evaluate_ends(dvi__rattle_members *r, const dvi__rattle_lanes *l, double h)
{
  members_place(r, (size_t)r->system->n * (size_t)l->count, l->q, l->q_compensation);
  r->chosen = 0;
  for (int k = 0; k < l->count; k++) {
    if (r->on[k] == 0) continue;
    r->member[r->chosen++] = k;
    r->values_taken[k]++;
  }
  ask_chosen(r, l,
             &(request){.function = dvi__rows_values,
                        .rows = (size_t)r->system->row_count,
                        .most = DVI_HOLONOMIC_POINTS,
                        .h = h,
                        .q = r->x,
                        .result = r->w});
}

static dvi_status rates_of_one(dvi__evaluator *e, int count, const double *t, const double *q,
                               double *phi_t)
{
  (void)count;
  return dvi__rows_rate(e, *t, q, phi_t);
}

static void evaluate_rates(dvi__rattle_members *r, const dvi__rattle_lanes *l)
{
  const size_t rows = (size_t)r->system->row_count;
  memset(r->phi_t, 0, rows * (size_t)l->count * sizeof(double));
  r->chosen = 0;
  for (int k = 0; k < l->count && r->has_rates; k++)
    if (!l->left[k]) r->member[r->chosen++] = k;
  ask_chosen(
      r, l,
      &(request){.function = rates_of_one, .rows = rows, .most = 1, .q = l->q, .result = r->phi_t});
}

/* ---- the start of a step ---- */

int dvi__rattle_is_settled(double moved, double last, double size)
{
  const double rounding = DBL_EPSILON * size, shrunk = moved / last;
  if (moved <= rounding) return 1;
  if (last == HUGE_VAL) return 0;
  return (shrunk < DVI__RATTLE_FAST_CHANGE &&
          moved * shrunk <= DVI__RATTLE_FAST_CHANGE * rounding) ||
         (moved <= 1e-10 * size && shrunk >= 0.5);
}

/* End the iteration of lanes that have settled, or cannot go on with their matrices. Returns how
 * many go on. */
static int test_members(dvi__rattle_members *r, const dvi__rattle_lanes *l)
{
  int going = 0;
  for (size_t k = 0; k < (size_t)l->count; k++) {
    if (r->on[k] == 0) continue;
    r->solves[k]++;
    const int is_settled = dvi__rattle_is_settled(r->moved[k], r->last[k], r->size[k]),
              serves = !(r->last[k] < HUGE_VAL) ||
                       r->moved[k] <= DVI__RATTLE_FAST_CHANGE * r->last[k];
    if (r->doubt[k] != 0 || !(is_settled || serves)) leave(r, l, k);
    if (is_settled) r->on[k] = 0;
    going += r->on[k] != 0;
  }
  return going;
}

static void find_multipliers(dvi__rattle_members *r, const dvi__rattle_lanes *l, double h)
{
  const size_t width = (size_t)l->count;
  int going = 1;
  for (size_t k = 0; k < width; k++) {
    r->on[k] = !l->left[k];
    r->moved[k] = HUGE_VAL;
  }
  for (int iteration = 0; iteration < DVI__RATTLE_ITERATIONS && going > 0; iteration++) {
    evaluate_ends(r, l, h);
    dvi__members_definite_solve(r->factor, l->count, r->w);
    members_pull(r, width, r->moved_q, r->w, 1);
    members_correct(r, width, 2 / (h * h), l->lambda);
    going = test_members(r, l);
  }
  for (size_t k = 0; k < width; k++)
    if (r->on[k] != 0) leave(r, l, k);
}

/* Guess the multipliers, and set w to h^2/2 of them. */
static void guess_start(dvi__rattle_members *r, const dvi__rattle_lanes *l, double h)
{
  const size_t numbers = (size_t)r->system->row_count * (size_t)l->count;
  for (size_t i = 0; i < numbers; i++) {
    r->mu[i] = l->lambda[i];
    l->lambda[i] += h * l->trend[i];
    r->w[i] = 0.5 * h * h * l->lambda[i];
  }
}

/* Add the momenta x. Members that are left keep theirs, since what they have may be anything. */
static void add_momenta(dvi__rattle_members *r, const dvi__rattle_lanes *l)
{
  const size_t n = (size_t)r->system->n, width = (size_t)l->count;
  for (size_t k = 0; k < width; k++)
    for (size_t i = 0; i < n && l->left[k]; i++) r->x[i * width + k] = 0;
  dvi__lanes_add_scaled(n * width, 1.0, r->x, l->p, l->p_compensation);
}

void dvi__rattle_members_begin(dvi__rattle_members *r, const dvi__rattle_lanes *l, double h)
{
  const size_t width = (size_t)l->count, numbers = (size_t)r->system->row_count * width;
  memset(r->values_taken, 0, width * sizeof(long));
  memset(r->solves, 0, width * sizeof(long));
  memset(r->new, 0, width * sizeof(long));
  factor_members(r, l);
  guess_start(r, l, h);
  members_pull(r, width, r->moved_q, r->w, 1);
  members_guess(r, width, l->q, l->p, h);
  find_multipliers(r, l, h);
  for (size_t i = 0; i < numbers; i++)
    if (r->mu[i] != 0) l->trend[i] = (l->lambda[i] - r->mu[i]) / h;
  members_pull(r, width, r->phi_q, l->lambda, -0.5 * h);
  add_momenta(r, l);
}

/* ---- the end of a step ---- */

/* Correct mu of the lanes that are on. Those that are to be corrected once more stay on. Returns
 * how many there are. */
static int correct_end(dvi__rattle_members *r, const dvi__rattle_lanes *l)
{
  const size_t width = (size_t)l->count;
  int again = 0;
  members_pull(r, width, r->phi_q, r->mu, -1);
  members_push(r, width, l->p, l->p_compensation);
  dvi__members_definite_solve(r->factor, l->count, r->w);
  members_correct_end(r, width);
  for (size_t k = 0; k < width; k++) {
    if (r->on[k] == 0) continue;
    r->solves[k]++;
    if (r->doubt[k] != 0) leave(r, l, k);
    r->on[k] = r->on[k] != 0 && r->moved[k] / r->size[k] > DVI__RATTLE_SMALL_CHANGE;
    again += r->on[k] != 0;
  }
  return again;
}

/* Count the step of each member as dvi__rattle does. */
static void count_members(const dvi__rattle_members *r, const dvi__rattle_lanes *l)
{
  for (size_t k = 0; k < (size_t)l->count; k++) {
    if (l->left[k]) continue;
    l->residuals[k] += r->values_taken[k];
    l->gradients[k] += r->new[k];
    r->counters->values += r->values_taken[k];
    r->counters->jacobians += r->new[k];
    r->counters->factorizations += r->new[k];
    r->counters->solves += r->solves[k];
    r->counters->simplified++;
  }
}

void dvi__rattle_members_end(dvi__rattle_members *r, const dvi__rattle_lanes *l, double h)
{
  const size_t width = (size_t)l->count, numbers = (size_t)r->system->row_count * width;
  for (size_t i = 0; i < numbers; i++)
    r->mu[i] = 0.5 * h * (l->lambda[i] + h * l->trend[numbers + i]);
  factor_members(r, l);
  evaluate_rates(r, l);
  for (size_t k = 0; k < width; k++) r->on[k] = !l->left[k];
  if (correct_end(r, l) > 0) (void)correct_end(r, l);
  members_pull(r, width, r->phi_q, r->mu, -1);
  add_momenta(r, l);
  for (size_t i = 0; i < numbers; i++) {
    const double at_end = 2 * r->mu[i] / h;
    l->trend[numbers + i] = (at_end - l->lambda[i]) / h;
    l->lambda[i] = at_end;
  }
  count_members(r, l);
}
