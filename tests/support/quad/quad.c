/* Gragg's explicit midpoint rule, extrapolated (Hairer, Norsett and Wanner 1993, sec. II.9): with
 * 2, 4, .. 2K substeps its error has an expansion in even powers of the substep, so K of them give
 * order 2K. The step follows the difference of the last two columns. */
#include "quad.h"

#include <math.h>
#include <string.h>

#include "quad_system.h"

#define COLUMNS 12
#define STATE_MAX (2 * QUAD_N_MAX + 1)

/* Evaluates rate = (v, a, 1) at y = (q, v, time). */
static void evaluate(const quad_field *f, const quad *y, quad *rate)
{
  const int n = f->system.n;
  if (f->problem->rate) {
    f->problem->rate(&f->system, y, rate);
    for (int i = 0; i < n; i++) rate[n + i] = 0;
    return;
  }
  rate[2 * n] = 1;
  if (f->problem->flow) {
    f->problem->flow(&f->system, y, rate);
    return;
  }
  for (int i = 0; i < n; i++) rate[i] = y[n + i];
  f->problem->acceleration(&f->system, y, y + n, rate + n);
}

/* Applies the midpoint rule over a step of h in `count` (even) substeps. */
static void midpoint(const quad_field *f, const quad *y, const quad *rate, quad h, int count,
                     quad *end)
{
  const int size = 2 * f->system.n + 1;
  const quad substep = h / count;
  quad before[STATE_MAX], here[STATE_MAX], here_rate[STATE_MAX];
  for (int i = 0; i < size; i++) {
    before[i] = y[i];
    here[i] = y[i] + substep * rate[i];
  }
  for (int step = 1; step < count; step++) {
    evaluate(f, here, here_rate);
    for (int i = 0; i < size; i++) {
      const quad next = before[i] + 2 * substep * here_rate[i];
      before[i] = here[i];
      here[i] = next;
    }
  }
  memcpy(end, here, (size_t)size * sizeof *end);
}

static quad largest(int count, const quad *x)
{
  quad most = 0;
  for (int i = 0; i < count; i++) {
    if (!(quad_abs(x[i]) <= most)) most = quad_abs(x[i]);
    if (!(most >= 0)) break; /* a NaN stays */
  }
  return most;
}

/* Returns the larger one of |x - y| relative to |x| in the first half (q) and in the second (v or
 * p). */
static quad distance(int n, const quad *x, const quad *y)
{
  quad difference[STATE_MAX] = {0};
  for (int i = 0; i < 2 * n; i++) difference[i] = x[i] - y[i];
  const quad q = largest(n, x), v = largest(n, x + n);
  const quad in_q = largest(n, difference) / (q > 0 ? q : 1),
             in_v = largest(n, difference + n) / (v > 0 ? v : 1);
  return in_q <= in_v ? in_v : in_q;
}

/* Takes a step of h, and returns the difference of the last two columns of the extrapolation
 * table. */
static quad extrapolate(const quad_field *f, const quad *y, quad h, quad *end)
{
  const int n = f->system.n, size = 2 * n + 1;
  quad rate[STATE_MAX], row[COLUMNS][STATE_MAX], last[STATE_MAX];
  evaluate(f, y, rate);
  for (int j = 0; j < COLUMNS; j++) {
    midpoint(f, y, rate, h, 2 * (j + 1), row[j]);
    for (int k = j - 1; k >= 0; k--) { /* row[k] becomes the entry that uses substeps k .. j */
      const quad ratio = (quad)(j + 1) / (k + 1);
      if (k == 0 && j == COLUMNS - 1) memcpy(last, row[1], sizeof last);
      for (int i = 0; i < size; i++)
        row[k][i] = row[k + 1][i] + (row[k + 1][i] - row[k][i]) / (ratio * ratio - 1);
    }
  }
  memcpy(end, row[0], (size_t)size * sizeof *end);
  return distance(n, end, last);
}

/* Advances y by time t. `coarse` takes the steps that the tolerance asks for, `fine` takes two
 * steps of half the length. Returns their distance. */
quad quad_march(const quad_field *f, quad t, quad *y)
{
  const quad tolerance = quad_parse("1e-30", NULL);
  const int n = f->system.n;
  const size_t bytes = (2 * (size_t)n + 1) * sizeof *y;
  quad coarse[STATE_MAX], fine[STATE_MAX], next[STATE_MAX], left = t, h = t;
  memcpy(coarse, y, bytes);
  memcpy(fine, y, bytes);
  while (left < 0 || left > 0) {
    if (quad_abs(h) > quad_abs(left)) h = left;
    const quad error = extrapolate(f, coarse, h, next) / tolerance;
    if (error <= 1) {
      memcpy(coarse, next, bytes);
      extrapolate(f, fine, h / 2, next);
      extrapolate(f, next, h / 2, fine);
      left -= h;
    }
    const double factor = 0.8 * pow((double)error + 1e-30, -1.0 / (2 * COLUMNS - 1));
    h *= (quad)(factor > 0.2 ? fmin(factor, 2.0) : 0.2);
    if (fabs((double)h) < 1e-20) return (quad)nan("");
  }
  memcpy(y, fine, bytes);
  return distance(n, fine, coarse);
}

int quad_prepare(quad_field *f, const char *problem, int setting_count, const char *const *settings)
{
  memset(f, 0, sizeof *f);
  f->problem = quad_problem_find(problem);
  if (!f->problem) return 0;
  for (int i = 0; f->problem->parameter[i]; i++)
    f->system.value[i] = quad_number(f->problem->standard[i]);
  for (int s = 0; s < setting_count; s++) {
    const size_t length = strcspn(settings[s], "=");
    int i = 0;
    while (f->problem->parameter[i] &&
           (strncmp(f->problem->parameter[i], settings[s], length) != 0 ||
            f->problem->parameter[i][length]))
      i++;
    if (!f->problem->parameter[i] || settings[s][length] != '=') return 0;
    f->system.value[i] = quad_number(settings[s] + length + 1);
  }
  f->problem->prepare(&f->system);
  if (f->system.nv == 0) f->system.nv = f->system.n;
  return f->system.n > 0;
}

void quad_momentum(const quad_field *f, const quad *y, quad *p)
{
  const int n = f->system.n;
  if (f->problem->momentum)
    f->problem->momentum(&f->system, y, y + n, p);
  else
    memcpy(p, y + n, (size_t)n * sizeof *p);
}

double quad_solve(const char *problem, int setting_count, const char *const *settings, double t,
                  double *q, double *p)
{
  quad_field f;
  quad y[STATE_MAX] = {0}, momenta[QUAD_N_MAX];
  if (!quad_prepare(&f, problem, setting_count, settings)) return nan("");
  const int n = f.system.n;
  const int nv = f.system.nv;
  for (int i = 0; i < n; i++) y[i] = (quad)q[i];
  for (int i = 0; i < nv; i++) {
    momenta[i] = (quad)p[i];
    y[n + i] = f.problem->rate ? 0 : (quad)p[i];
  }
  if (f.problem->velocity) f.problem->velocity(&f.system, y, momenta, y + n);
  const double error = (double)quad_march(&f, (quad)t, y);
  quad_momentum(&f, y, momenta);
  for (int i = 0; i < n; i++) q[i] = (double)y[i];
  for (int i = 0; i < nv; i++) p[i] = (double)momenta[i];
  return error;
}

double quad_digits(const char *problem, int setting_count, const char *const *settings, double t,
                   int *n, char (*q)[QUAD_TEXT], char (*p)[QUAD_TEXT])
{
  quad_field f;
  quad y[STATE_MAX] = {0}, momenta[QUAD_N_MAX];
  if (!quad_prepare(&f, problem, setting_count, settings)) return nan("");
  *n = f.system.n;
  memcpy(y, f.system.q, (size_t)*n * sizeof *y);
  memcpy(y + *n, f.system.v, (size_t)*n * sizeof *y);
  const double error = (double)quad_march(&f, (quad)t, y);
  quad_momentum(&f, y, momenta);
  for (int i = 0; i < *n; i++) quad_print(q[i], QUAD_TEXT, QUAD_FORMAT, y[i]);
  for (int i = 0; i < f.system.nv; i++) quad_print(p[i], QUAD_TEXT, QUAD_FORMAT, momenta[i]);
  return error;
}
