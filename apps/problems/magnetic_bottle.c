/* A charge in a magnetic bottle, a field that grows along its axis,
 *
 *     L = v.v/2 + A(q).v,   A = B (1 + z^2/l^2)/2 (-y, x, 0). */
#include "entry.h"

typedef struct bottle {
  double B, l;
} bottle;

static double half_field(const bottle *own, double z)
{
  return 0.5 * own->B * (1.0 + z / own->l * (z / own->l));
}

static int bottle_value(int count, const double *t, const double *q, double *A, void *user)
{
  const double *x = q, *y = q + count, *z = q + 2 * count;
  (void)t;
  for (int k = 0; k < count; k++) {
    const double half = half_field(user, z[k]);
    A[k] = -half * y[k];
    A[count + k] = half * x[k];
    A[2 * count + k] = 0.0;
  }
  return 0;
}

/* The entries are dA_x/dy, dA_x/dz, dA_y/dx, dA_y/dz. */
static int bottle_gradient(int count, const double *t, const double *q, double *A_q, void *user)
{
  const bottle *own = user;
  const double *x = q, *y = q + count, *z = q + 2 * count;
  (void)t;
  for (int k = 0; k < count; k++) {
    const double half = half_field(own, z[k]), slope = own->B * z[k] / (own->l * own->l);
    A_q[k] = -half;
    A_q[count + k] = -slope * y[k];
    A_q[2 * count + k] = half;
    A_q[3 * count + k] = slope * x[k];
  }
  return 0;
}

/* The entries are (z,x), (z,y), (x,z), (y,z), (z,z). */
static int bottle_hessian(int count, const double *t, const double *q, const double *w,
                          double *A_w_qq, void *user)
{
  const bottle *own = user;
  const double *x = q, *y = q + count, *z = q + 2 * count, bend = own->B / (own->l * own->l);
  (void)t;
  for (int k = 0; k < count; k++) {
    const double w_x = w[k], w_y = w[count + k];
    A_w_qq[k] = A_w_qq[2 * count + k] = bend * z[k] * w_y;
    A_w_qq[count + k] = A_w_qq[3 * count + k] = -bend * z[k] * w_x;
    A_w_qq[4 * count + k] = bend * (x[k] * w_y - y[k] * w_x);
  }
  return 0;
}

static int turn_about_the_axis(const double *q, double *xi, void *user)
{
  (void)user;
  xi[0] = -q[1];
  xi[1] = q[0];
  xi[2] = 0.0;
  return 0;
}

static dvi_status magnetic_bottle_make(const double *setting, problem *made)
{
  static const int start[] = {0, 2, 4, 4}, row[] = {1, 2, 0, 2};
  static const int second_start[] = {0, 1, 2, 5}, second_row[] = {2, 2, 0, 1, 2};
  static const char *const names[] = {"x", "y", "z"};
  const dvi_status status = problem_room(made, 3, sizeof(bottle));
  if (status != DVI_OK) return status;
  bottle *own = made->parameters;
  *own = (bottle){.B = setting[0], .l = setting[1]};
  for (int i = 0; i < 3; i++) problem_label(made, i, "%s", names[i]);
  made->q[0] = 1.0;
  made->v[1] = 0.6;
  made->v[2] = 0.5;
  const dvi_vector_potential A = {.value_batch = bottle_value,
                                  .gradient_batch = bottle_gradient,
                                  .hessian_batch = bottle_hessian,
                                  .gradients = {start, row},
                                  .qq = {second_start, second_row},
                                  .user = own};
  const dvi_symmetry turn = {.name = "angular_momentum", .generator = turn_about_the_axis};
  const dvi_system_terms terms = {.dimension = 3,
                                  .mass = {.scalar = 1.0},
                                  .vector_potential = &A,
                                  .symmetries = &turn,
                                  .symmetry_count = 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "B",
     .value = 4.0,
     .least = -1e3,
     .most = 1e3,
     .help = "the field in the middle, any number to 1000"},
    {.name = "l",
     .value = 2.0,
     .least = 1e-2,
     .most = 1e6,
     .help = "the distance on the axis over which the field doubles, 0.01 to 1e6"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {1.2328636386379045, 0.15057031665190117, 0.056986697531682995};
static const double digits_p[] = {0.24253749510515989, 2.1385324903821710, -0.45362733697280635};

const problem_entry problem_entry_magnetic_bottle = {
    .name = "magnetic-bottle",
    .summary = "a charge in a field that grows along its axis; a vector potential",
    .parameters = parameters,
    .make = magnetic_bottle_make,
    .h = 0.1,
    .t_end = 50.0,
    .order_h = 0.2,
    .order_t_end = 10.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
