/* A knife edge on an inclined plane, whose x axis points downhill,
 *
 *     L = m (x'^2 + y'^2)/2 + J a'^2/2 + m g sin(slope) x,   sin(a) x' - cos(a) y' = 0.
 *
 * It moves along the edge alone. In the mean it does not slide down, but across the slope. Source:
 * Bloch 2003, sec. 1.6. */
#include <math.h>

#include "entry.h"

typedef struct knife {
  double mass[3], m, g, slope, u, turn;
} knife;

static int slope_potential(double t, const double *q, double *V, void *user)
{
  const knife *own = user;
  (void)t;
  *V = -own->m * own->g * sin(own->slope) * q[0];
  return 0;
}

static int slope_gradient(double t, const double *q, double *V_q, void *user)
{
  const knife *own = user;
  (void)t, (void)q;
  V_q[0] = -own->m * own->g * sin(own->slope);
  V_q[1] = V_q[2] = 0.0;
  return 0;
}

static int slope_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)V_qq, (void)user;
  return 0;
}

static int blade(double t, const double *q, double *A, void *user)
{
  (void)t, (void)user;
  A[0] = sin(q[2]);
  A[1] = -cos(q[2]);
  return 0;
}

static int blade_derivative(double t, const double *q, const double *v, double *Av_q, void *user)
{
  (void)t, (void)user;
  Av_q[0] = cos(q[2]) * v[0] + sin(q[2]) * v[1];
  return 0;
}

/* The velocity along the edge is u + (G/w) sin wt with w = turn and G = g sin(slope). */
static int knife_exact(const problem *made, double t, double *q, double *p)
{
  const knife *own = made->parameters;
  const double w = own->turn, G = own->g * sin(own->slope), s = sin(w * t), c = cos(w * t),
               along = own->u + G / w * s;
  q[0] = own->u / w * s + G / (2.0 * w * w) * s * s;
  q[1] = own->u / w * (1.0 - c) + G / (2.0 * w) * (t - s * c / w);
  q[2] = w * t;
  p[0] = own->mass[0] * along * c;
  p[1] = own->mass[1] * along * s;
  p[2] = own->mass[2] * w;
  return 0;
}

static dvi_status knife_edge_make(const double *setting, problem *made)
{
  static const int nothing[] = {0, 0, 0, 0}, blade_start[] = {0, 2}, blade_row[] = {0, 1},
                   by_angle[] = {0, 0, 0, 1};
  const dvi_status status = problem_room(made, 3, sizeof(knife));
  if (status != DVI_OK) return status;
  knife *own = made->parameters;
  *own = (knife){.mass = {setting[0], setting[0], setting[1]},
                 .m = setting[0],
                 .g = setting[2],
                 .slope = setting[3],
                 .u = setting[4],
                 .turn = setting[5]};
  problem_label(made, 0, "x");
  problem_label(made, 1, "y");
  problem_label(made, 2, "a");
  made->v[0] = own->u;
  made->v[2] = own->turn;

  const dvi_potential potential = {.name = "slope",
                                   .value = slope_potential,
                                   .gradient = slope_gradient,
                                   .hessian = slope_hessian,
                                   .qq = {nothing, nothing},
                                   .quadratic = 1,
                                   .user = own};
  const dvi_nonholonomic rows = {.name = "blade",
                                 .count = 1,
                                 .value = blade,
                                 .derivative = blade_derivative,
                                 .transposed = {blade_start, blade_row},
                                 .by_q = {by_angle, nothing},
                                 .user = own};
  const dvi_system_terms terms = {.dimension = 3,
                                  .mass = {.diagonal = own->mass},
                                  .potentials = &potential,
                                  .potential_count = 1,
                                  .nonholonomics = &rows,
                                  .nonholonomic_count = 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    PROBLEM_MASS(1.0),
    {.name = "J",
     .value = 0.5,
     .least = 1e-50,
     .most = 1e50,
     .help = "the moment of inertia, positive"},
    PROBLEM_GRAVITY(9.81),
    {.name = "slope",
     .value = 0.3,
     .least = -1.5,
     .most = 1.5,
     .help = "the slope of the plane, -1.5 to 1.5 rad"},
    {.name = "u", .value = 1.0, .least = -1e6, .most = 1e6, .help = "the speed at the start"},
    {.name = "turn",
     .value = 2.0,
     .least = 1e-3,
     .most = 1e3,
     .help = "the angular velocity, 1e-3 to 1e3"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {-0.16476045488062824, 4.3779349940032954, 10.0};
static const double digits_p[] = {-0.17740231019802202, -0.11502070863314312, 1.0};

const problem_entry problem_entry_knife_edge = {
    .name = "knife-edge",
    .summary = "a knife edge on an inclined plane; nonholonomic",
    .parameters = parameters,
    .make = knife_edge_make,
    .exact = knife_exact,
    .h = 0.05,
    .t_end = 20.0,
    .order_h = 0.1,
    .order_t_end = 5.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
