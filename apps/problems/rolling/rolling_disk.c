/* An upright disk that rolls without slipping, with the heading a and the turn th about its axle,
 *
 *     L = m (x'^2 + y'^2)/2 + J a'^2/2 + I th'^2/2,   x' = R cos(a) th',   y' = R sin(a) th'.
 *
 * It runs in circles of radius R spin/turn. Source: Bloch 2003, sec. 1.4. */
#include <math.h>

#include "entry.h"

enum { X, Y, A, TH, N };

typedef struct disk {
  double mass[N], R, turn, spin;
} disk;

static int rolling(double t, const double *q, double *rows, void *user)
{
  const disk *own = user;
  (void)t;
  rows[0] = rows[2] = 1.0;
  rows[1] = -own->R * cos(q[A]);
  rows[3] = -own->R * sin(q[A]);
  return 0;
}

static int rolling_derivative(double t, const double *q, const double *v, double *Av_q, void *user)
{
  const disk *own = user;
  (void)t;
  Av_q[0] = own->R * sin(q[A]) * v[TH];
  Av_q[1] = -own->R * cos(q[A]) * v[TH];
  return 0;
}

static int disk_exact(const problem *made, double t, double *q, double *p)
{
  const disk *own = made->parameters;
  const double w = own->turn, u = own->R * own->spin, half = sin(0.5 * w * t);
  q[X] = u / w * sin(w * t);
  q[Y] = 2.0 * u / w * half * half;
  q[A] = w * t;
  q[TH] = own->spin * t;
  p[X] = own->mass[X] * u * cos(w * t);
  p[Y] = own->mass[Y] * u * sin(w * t);
  p[A] = own->mass[A] * w;
  p[TH] = own->mass[TH] * own->spin;
  return 0;
}

static dvi_status rolling_disk_make(const double *setting, problem *made)
{
  static const int rows_start[] = {0, 2, 4}, rows_row[] = {X, TH, Y, TH},
                   by_start[] = {0, 0, 0, 2, 2}, by_row[] = {0, 1};
  static const char *const label[] = {"x", "y", "a", "th"};
  const dvi_status status = problem_room(made, N, sizeof(disk));
  if (status != DVI_OK) return status;
  disk *own = made->parameters;
  *own = (disk){.mass = {setting[0], setting[0], setting[1], setting[2]},
                .R = setting[3],
                .turn = setting[4],
                .spin = setting[5]};
  for (int i = 0; i < N; i++) problem_label(made, i, "%s", label[i]);
  made->v[X] = own->R * own->spin;
  made->v[A] = own->turn;
  made->v[TH] = own->spin;

  const dvi_nonholonomic rows = {.name = "rolling",
                                 .count = 2,
                                 .value = rolling,
                                 .derivative = rolling_derivative,
                                 .transposed = {rows_start, rows_row},
                                 .by_q = {by_start, by_row},
                                 .user = own};
  const dvi_system_terms terms = {.dimension = N,
                                  .mass = {.diagonal = own->mass},
                                  .nonholonomics = &rows,
                                  .nonholonomic_count = 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    PROBLEM_MASS(1.0),
    {.name = "J",
     .value = 0.0625,
     .least = 1e-50,
     .most = 1e50,
     .help = "the moment of inertia about a diameter, positive"},
    {.name = "I",
     .value = 0.125,
     .least = 1e-50,
     .most = 1e50,
     .help = "the moment of inertia about the axle, positive"},
    {.name = "R", .value = 0.5, .least = 1e-6, .most = 1e6, .help = "the radius, positive"},
    {.name = "turn",
     .value = 0.7,
     .least = 1e-3,
     .most = 1e3,
     .help = "the angular velocity of the heading, 1e-3 to 1e3"},
    {.name = "spin",
     .value = 3.0,
     .least = -1e3,
     .most = 1e3,
     .help = "the angular velocity about the axle, -1e3 to 1e3"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {-0.7516783450491854, 4.1495500441945632, 3.5, 15.0};
static const double digits_p[] = {-1.4046850309361945, -0.52617484153442973, 0.04375, 0.375};

const problem_entry problem_entry_rolling_disk = {
    .name = "rolling-disk",
    .summary = "an upright disk that rolls in circles; nonholonomic",
    .parameters = parameters,
    .make = rolling_disk_make,
    .exact = disk_exact,
    .h = 0.05,
    .t_end = 20.0,
    .order_h = 0.1,
    .order_t_end = 5.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
