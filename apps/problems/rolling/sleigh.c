/* Chaplygin's sleigh, a body on ice with a blade behind its centre of mass (x,y),
 *
 *     L = m (x'^2 + y'^2)/2 + J th'^2/2,   sin(th) x' - cos(th) y' + a th' = 0.
 *
 * It ends in a straight line, although its energy stays the same. Source: Bloch 2003, sec. 1.7. */
#include <math.h>

#include "entry.h"

typedef struct sleigh {
  double mass[3], a;
} sleigh;

static int blade(double t, const double *q, double *A, void *user)
{
  const sleigh *own = user;
  (void)t;
  A[0] = sin(q[2]);
  A[1] = -cos(q[2]);
  A[2] = own->a;
  return 0;
}

static int blade_derivative(double t, const double *q, const double *v, double *Av_q, void *user)
{
  (void)t, (void)user;
  Av_q[0] = cos(q[2]) * v[0] + sin(q[2]) * v[1];
  return 0;
}

static dvi_status sleigh_make(const double *setting, problem *made)
{
  static const int by_angle[] = {0, 0, 0, 1}, first_row[] = {0};
  const dvi_status status = problem_room(made, 3, sizeof(sleigh));
  if (status != DVI_OK) return status;
  sleigh *own = made->parameters;
  *own = (sleigh){.mass = {setting[0], setting[0], setting[1]}, .a = setting[2]};
  problem_label(made, 0, "x");
  problem_label(made, 1, "y");
  problem_label(made, 2, "th");
  made->v[0] = 1.0;
  made->v[1] = 2.0 * own->a;
  made->v[2] = 2.0;

  const dvi_nonholonomic rows = {.name = "blade",
                                 .count = 1,
                                 .value = blade,
                                 .derivative = blade_derivative,
                                 .by_q = {by_angle, first_row},
                                 .user = own};
  const dvi_system_terms terms = {.dimension = 3,
                                  .mass = {.diagonal = own->mass},
                                  .nonholonomics = &rows,
                                  .nonholonomic_count = 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    PROBLEM_MASS(1.0),
    {.name = "J",
     .value = 0.2,
     .least = 1e-50,
     .most = 1e50,
     .help = "the moment of inertia about the centre of mass, positive"},
    {.name = "a",
     .value = 0.3,
     .least = -1e6,
     .most = 1e6,
     .help = "the distance of the blade behind the centre of mass"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {1.5364900018622347, 6.9108480419845257, 1.4755952451342538};
static const double digits_p[] = {0.1393500805748473, 1.4630725451191371, 0.00023780765085504085};

const problem_entry problem_entry_sleigh = {
    .name = "sleigh",
    .summary = "Chaplygin's sleigh, a body with a blade on ice; nonholonomic",
    .parameters = parameters,
    .make = sleigh_make,
    .h = 0.05,
    .t_end = 20.0,
    .order_h = 0.1,
    .order_t_end = 5.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
