/* Three equal cranks that hang from pivots in a row and carry one coupler,
 *
 *     L = m l^2/6 (a'^2 + b'^2 + c'^2) + M (x'^2 + y'^2)/2 + M d^2/6 w'^2
 *         + m g l/2 (cos a + cos b + cos c) - M g y.
 *
 * The cranks are uniform rods of length l with the angles a, b, c from straight down, and pivots at
 * (-d,0), (0,0), (d,0). The coupler is a uniform rod of length 2 d, with its centre at (x,y), at
 * the angle w. Its ends and its centre are the ends of the cranks, which makes six rows of rank 5.
 * The machine is a pendulum, a = b = c and a'' = -k sin a, k = (3 m/2 + M)/(m + M) g/l. */
#include <math.h>

#include "entry.h"

enum { A, B, C, X, Y, W, N, ROWS = 6 };

typedef struct cranks {
  double mass[N], m, l, d, M, g;
} cranks;

static int weight(double t, const double *q, double *V, void *user)
{
  const cranks *own = user;
  (void)t;
  *V = own->M * own->g * q[Y];
  for (int i = 0; i < 3; i++) *V -= own->m * own->g * own->l / 2 * cos(q[i]);
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  const cranks *own = user;
  (void)t;
  for (int i = 0; i < 3; i++) V_q[i] = own->m * own->g * own->l / 2 * sin(q[i]);
  V_q[X] = V_q[W] = 0;
  V_q[Y] = own->M * own->g;
  return 0;
}

static int weight_hessian(double t, const double *q, double *V_qq, void *user)
{
  const cranks *own = user;
  (void)t;
  for (int i = 0; i < 3; i++) V_qq[i] = own->m * own->g * own->l / 2 * cos(q[i]);
  return 0;
}

/* Rows 2 i and 2 i + 1 are those of crank i = 0, 1, 2, whose end is at (i - 1) d along the
 * coupler. */
static int ends(double t, const double *q, double *phi, void *user)
{
  const cranks *own = user;
  (void)t;
  for (int i = 0; i < 3; i++) {
    const double d = (i - 1) * own->d;
    phi[2 * i] = d + own->l * sin(q[i]) - q[X] - d * cos(q[W]);
    phi[2 * i + 1] = -own->l * cos(q[i]) - q[Y] - d * sin(q[W]);
  }
  return 0;
}

/* Each row meets its crank, the coupler's centre, and its angle. */
static int ends_gradient(double t, const double *q, double *phi_q, void *user)
{
  const cranks *own = user;
  (void)t;
  for (int i = 0; i < 3; i++) {
    const double d = (i - 1) * own->d;
    double *x = phi_q + 6 * i, *y = x + 3;
    x[0] = own->l * cos(q[i]);
    y[0] = own->l * sin(q[i]);
    x[1] = y[1] = -1;
    x[2] = d * sin(q[W]);
    y[2] = -d * cos(q[W]);
  }
  return 0;
}

static int ends_hessian(double t, const double *q, const double *w, double *phi_w, void *user)
{
  const cranks *own = user;
  (void)t;
  phi_w[3] = 0;
  for (int i = 0; i < 3; i++) {
    const double d = (i - 1) * own->d;
    phi_w[i] = own->l * (w[2 * i + 1] * cos(q[i]) - w[2 * i] * sin(q[i]));
    phi_w[3] += d * (w[2 * i] * cos(q[W]) + w[2 * i + 1] * sin(q[W]));
  }
  return 0;
}

static void label_cranks(problem *made)
{
  static const char *const names[N] = {"a", "b", "c", "x", "y", "w"};
  for (int i = 0; i < N; i++) problem_label(made, i, "%s", names[i]);
}

static dvi_status three_cranks_make(const double *setting, problem *made)
{
  static const int turns_start[] = {0, 1, 2, 3, 3, 3, 3}, turns_row[] = {A, B, C},
                   rows_start[] = {0, 3, 6, 9, 12, 15, 18},
                   rows_row[] = {A, X, W, A, Y, W, B, X, W, B, Y, W, C, X, W, C, Y, W},
                   bends_start[] = {0, 1, 2, 3, 3, 3, 4}, bends_row[] = {A, B, C, W};
  static const char *const row_names[ROWS] = {"left_x",   "left_y",  "middle_x",
                                              "middle_y", "right_x", "right_y"};
  const dvi_status status = problem_room(made, N, sizeof(cranks));
  if (status != DVI_OK) return status;
  cranks *own = made->parameters;
  *own = (cranks){
      .m = setting[0], .l = setting[1], .d = setting[2], .M = setting[3], .g = setting[4]};
  for (int i = 0; i < 3; i++) {
    own->mass[i] = own->m * own->l * own->l / 3;
    made->q[i] = setting[5];
  }
  own->mass[X] = own->mass[Y] = own->M;
  own->mass[W] = own->M * own->d * own->d / 3;
  made->q[X] = own->l * sin(setting[5]);
  made->q[Y] = -own->l * cos(setting[5]);
  label_cranks(made);

  const dvi_potential potential = {.name = "weight",
                                   .value = weight,
                                   .gradient = weight_gradient,
                                   .hessian = weight_hessian,
                                   .qq = {turns_start, turns_row},
                                   .user = own};
  const dvi_holonomic rows = {.name = "ends",
                              .count = ROWS,
                              .value = ends,
                              .gradient = ends_gradient,
                              .hessian = ends_hessian,
                              .gradients = {rows_start, rows_row},
                              .qq = {bends_start, bends_row},
                              .row_names = row_names,
                              .user = own};
  const dvi_system_terms terms = {.dimension = N,
                                  .mass = {.diagonal = own->mass},
                                  .potentials = &potential,
                                  .potential_count = 1,
                                  .holonomics = &rows,
                                  .holonomic_count = 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    PROBLEM_MASS(0.4),
    {.name = "l", .value = 0.7, .least = 1e-3, .most = 1e3, .help = "the length of a crank"},
    {.name = "d", .value = 0.5, .least = 1e-3, .most = 1e3, .help = "the distance of the pivots"},
    {.name = "M", .value = 1.5, .least = 1e-50, .most = 1e50, .help = "the mass of the coupler"},
    PROBLEM_GRAVITY(9.81),
    {.name = "start",
     .value = 1.1,
     .least = -1.57,
     .most = 1.57,
     .help = "the angle of the cranks at the start, -1.57 to 1.57 rad"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {-0.086440107700033970, -0.086440107700033970,
                                  -0.086440107700033970, -0.060432751899697241,
                                  -0.69738646566866326,  0};
static const double digits_p[] = {0.26787744935077037, 0.26787744935077037,  0.26787744935077037,
                                  4.2890994099888543,  -0.37167638501339126, 0};

const problem_entry problem_entry_three_cranks = {
    .name = "three-cranks",
    .summary = "three cranks with one coupler; six constraints of rank 5",
    .parameters = parameters,
    .make = three_cranks_make,
    .h = 0.02,
    .t_end = 20.0,
    .order_h = 0.05,
    .order_t_end = 3.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
