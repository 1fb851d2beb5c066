/* A crank turns, a rod follows, and a slider runs on the x axis,
 *
 *     L = m1/2 (x1'^2 + y1'^2 + l1^2/12 a1'^2) + m2/2 (x2'^2 + y2'^2 + l2^2/12 a2'^2) + m3/2 x3'^2
 *         - m1 g y1 - m2 g y2.
 *
 * Crank and rod are uniform, with their centres at (x1,y1) and (x2,y2) and the angles a1 and a2.
 * Two rows hold the crank at the origin, two join it to the rod, and two lead the slider. */
#include <math.h>

#include "entry.h"

enum { X1, Y1, A1, X2, Y2, A2, X3, N, ROWS = 6 };

typedef struct slider {
  double mass[N], m1, m2, l1, l2, g;
} slider;

static int weight(double t, const double *q, double *V, void *user)
{
  const slider *own = user;
  (void)t;
  *V = own->g * (own->m1 * q[Y1] + own->m2 * q[Y2]);
  return 0;
}

static int weight_gradient(double t, const double *q, double *V_q, void *user)
{
  const slider *own = user;
  (void)t, (void)q;
  memset(V_q, 0, N * sizeof *V_q);
  V_q[Y1] = own->g * own->m1;
  V_q[Y2] = own->g * own->m2;
  return 0;
}

static int weight_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)V_qq, (void)user; /* no entries */
  return 0;
}

/* Vectors along the crank and the rod, of their lengths. */
typedef struct arms {
  double x1, y1, x2, y2;
} arms;

static arms arms_at(const slider *own, const double *q)
{
  return (arms){own->l1 * cos(q[A1]), own->l1 * sin(q[A1]), own->l2 * cos(q[A2]),
                own->l2 * sin(q[A2])};
}

static int joints(double t, const double *q, double *phi, void *user)
{
  const arms at = arms_at(user, q);
  (void)t;
  phi[0] = q[X1] - at.x1 / 2;
  phi[1] = q[Y1] - at.y1 / 2;
  phi[2] = q[X2] - at.x1 - at.x2 / 2;
  phi[3] = q[Y2] - at.y1 - at.y2 / 2;
  phi[4] = q[X3] - at.x1 - at.x2;
  phi[5] = at.y1 + at.y2;
  return 0;
}

static int joints_gradient(double t, const double *q, double *phi_q, void *user)
{
  const arms at = arms_at(user, q);
  const double entries[] = {1, at.y1 / 2,  1,     -at.x1 / 2, at.y1, 1,     at.y2 / 2, -at.x1,
                            1, -at.x2 / 2, at.y1, at.y2,      1,     at.x1, at.x2};
  (void)t;
  memcpy(phi_q, entries, sizeof entries);
  return 0;
}

static int joints_hessian(double t, const double *q, const double *w, double *phi_w, void *user)
{
  const arms at = arms_at(user, q);
  (void)t;
  phi_w[0] = (w[0] / 2 + w[2] + w[4]) * at.x1 + (w[1] / 2 + w[3] - w[5]) * at.y1;
  phi_w[1] = (w[2] / 2 + w[4]) * at.x2 + (w[3] / 2 - w[5]) * at.y2;
  return 0;
}

/* The crank starts at 45 degrees with the angular velocity `rate`. */
static void start_slider(const slider *own, double rate, double *q, double *v)
{
  q[A1] = 0.78539816339744830962; /* pi/4 */
  q[A2] = -asin(own->l1 * sin(q[A1]) / own->l2);
  const arms at = arms_at(own, q);
  const double follows = -at.x1 * rate / at.x2;
  q[X1] = at.x1 / 2;
  q[Y1] = at.y1 / 2;
  q[X2] = at.x1 + at.x2 / 2;
  q[Y2] = at.y1 + at.y2 / 2;
  q[X3] = at.x1 + at.x2;
  v[A1] = rate;
  v[A2] = follows;
  v[X1] = -at.y1 / 2 * rate;
  v[Y1] = at.x1 / 2 * rate;
  v[X2] = -at.y1 * rate - at.y2 / 2 * follows;
  v[Y2] = at.x1 * rate + at.x2 / 2 * follows;
  v[X3] = -at.y1 * rate - at.y2 * follows;
}

static dvi_status slider_system(slider *own, problem *made)
{
  static const int none[N + 1] = {0}, rows_start[] = {0, 2, 4, 7, 10, 13, 15},
                            rows_row[] = {X1, A1, Y1, A1, A1, X2, A2, A1,
                                          Y2, A2, A1, A2, X3, A1, A2},
                            bends_start[] = {0, 0, 0, 1, 1, 1, 2, 2}, bends_row[] = {A1, A2};
  static const char *const row_names[ROWS] = {"pin_x",  "pin_y",    "knee_x",
                                              "knee_y", "slider_x", "slider_y"};
  const dvi_potential potential = {.name = "weight",
                                   .value = weight,
                                   .gradient = weight_gradient,
                                   .hessian = weight_hessian,
                                   .qq = {none, none},
                                   .user = own};
  const dvi_holonomic rows = {.name = "joints",
                              .count = ROWS,
                              .value = joints,
                              .gradient = joints_gradient,
                              .hessian = joints_hessian,
                              .gradients = {rows_start, rows_row},
                              .qq = {bends_start, bends_row},
                              .row_names = row_names,
                              .user = own};
  return problem_system(made, &(dvi_system_terms){.dimension = N,
                                                  .mass = {.diagonal = own->mass},
                                                  .potentials = &potential,
                                                  .potential_count = 1,
                                                  .holonomics = &rows,
                                                  .holonomic_count = 1,
                                                  .autonomous = 1});
}

static dvi_status slider_crank_make(const double *setting, problem *made)
{
  static const char *const names[N] = {"x1", "y1", "a1", "x2", "y2", "a2", "x3"};
  const double l1 = setting[0], l2 = setting[1], m1 = setting[2], m2 = setting[3], m3 = setting[4];
  const dvi_status status = problem_room(made, N, sizeof(slider));
  if (status != DVI_OK) return status;
  slider *own = made->parameters;
  *own = (slider){.mass = {m1, m1, m1 * l1 * l1 / 12, m2, m2, m2 * l2 * l2 / 12, m3},
                  .m1 = m1,
                  .m2 = m2,
                  .l1 = l1,
                  .l2 = l2,
                  .g = setting[5]};
  for (int i = 0; i < N; i++) problem_label(made, i, "%s", names[i]);
  start_slider(own, setting[6], made->q, made->v);
  return slider_system(own, made);
}

static const problem_parameter parameters[] = {
    {.name = "l1", .value = 0.3, .least = 1e-3, .most = 1, .help = "the length of the crank"},
    {.name = "l2", .value = 1, .least = 1, .most = 1e3, .help = "the length of the rod, 1 or more"},
    {.name = "m1", .value = 0.2, .least = 1e-50, .most = 1e50, .help = "the mass of the crank"},
    {.name = "m2", .value = 0.5, .least = 1e-50, .most = 1e50, .help = "the mass of the rod"},
    {.name = "m3", .value = 0.3, .least = 1e-50, .most = 1e50, .help = "the mass of the slider"},
    PROBLEM_GRAVITY(9.81),
    {.name = "rate",
     .value = 6,
     .least = -1e50,
     .most = 1e50,
     .start_only = 1,
     .help = "the angular velocity of the crank at the start"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {-0.1019796435378281, -0.11000069228826478, 16.531182033544642,
                                  0.28379049272552681, -0.11000069228826478, 0.2218158898478278,
                                  0.77154027252670976};
static const double digits_p[] = {0.24557108398364841, -0.22766449089450139, 0.0167433776239411,
                                  1.0994942568539621,  -0.56916122723625351, 0.097242693351950446,
                                  0.58267985627380925};

const problem_entry problem_entry_slider_crank = {
    .name = "slider-crank",
    .summary = "a crank, a rod and a slider; seven coordinates, six constraints",
    .parameters = parameters,
    .make = slider_crank_make,
    .h = 0.01,
    .t_end = 20.0,
    .order_h = 0.01,
    .order_t_end = 2.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
