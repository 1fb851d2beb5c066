/* A snakeboard. The board has the centre (x,y) and the angle a, the rider turns by psi against it,
 * and the axles turn by -phi in front and phi behind,
 *
 *     L = m (x'^2 + y'^2)/2 + J a'^2/2 + Jr (a' + psi')^2/2 + Jw (a'^2 + phi'^2) - k psi^2/2
 *         - kw phi^2/2,
 *     -sin(a -+ phi) x' + cos(a -+ phi) y' +- r cos(phi) a' = 0.
 *
 * The rider gains speed without pushing off from the ground. Here springs move the rider and the
 * axles, so that the energy stays the same. Source: Bloch 2003, sec. 1.11. */
#include <math.h>

#include "entry.h"

enum { X, Y, A, PSI, PHI, N };

typedef struct snakeboard {
  double mass[7], k, kw, r;
} snakeboard;

static int springs_potential(double t, const double *q, double *V, void *user)
{
  const snakeboard *own = user;
  (void)t;
  *V = 0.5 * own->k * q[PSI] * q[PSI] + 0.5 * own->kw * q[PHI] * q[PHI];
  return 0;
}

static int springs_gradient(double t, const double *q, double *V_q, void *user)
{
  const snakeboard *own = user;
  (void)t;
  V_q[X] = V_q[Y] = V_q[A] = 0.0;
  V_q[PSI] = own->k * q[PSI];
  V_q[PHI] = own->kw * q[PHI];
  return 0;
}

static int springs_hessian(double t, const double *q, double *V_qq, void *user)
{
  const snakeboard *own = user;
  (void)t, (void)q;
  V_qq[0] = own->k;
  V_qq[1] = own->kw;
  return 0;
}

static int wheels(double t, const double *q, double *rows, void *user)
{
  const snakeboard *own = user;
  (void)t;
  for (int k = 0; k < 2; k++) {
    const int side = k ? -1 : 1;
    const double heading = q[A] - side * q[PHI];
    rows[3 * k] = -sin(heading);
    rows[3 * k + 1] = cos(heading);
    rows[3 * k + 2] = side * own->r * cos(q[PHI]);
  }
  return 0;
}

static int wheels_derivative(double t, const double *q, const double *v, double *Av_q, void *user)
{
  const snakeboard *own = user;
  (void)t;
  for (int k = 0; k < 2; k++) {
    const int side = k ? -1 : 1;
    const double heading = q[A] - side * q[PHI],
                 by_heading = -cos(heading) * v[X] - sin(heading) * v[Y];
    Av_q[k] = by_heading;
    Av_q[2 + k] = -side * (by_heading + own->r * sin(q[PHI]) * v[A]);
  }
  return 0;
}

static dvi_status snakeboard_make(const double *setting, problem *made)
{
  static const int mass_start[] = {0, 1, 2, 4, 6, 7}, mass_row[] = {X, Y, A, PSI, A, PSI, PHI},
                   spring_start[] = {0, 0, 0, 0, 1, 2}, spring_row[] = {PSI, PHI},
                   rows_start[] = {0, 3, 6}, rows_row[] = {X, Y, A, X, Y, A},
                   by_start[] = {0, 0, 0, 2, 2, 4}, by_row[] = {0, 1, 0, 1};
  const dvi_status status = problem_room(made, N, sizeof(snakeboard));
  if (status != DVI_OK) return status;
  snakeboard *own = made->parameters;
  const double m = setting[0], J = setting[1], Jr = setting[2], Jw = setting[3];
  *own = (snakeboard){.mass = {m, m, J + Jr + 2.0 * Jw, Jr, Jr, Jr, 2.0 * Jw},
                      .k = setting[4],
                      .kw = setting[5],
                      .r = setting[6]};
  static const char *const label[] = {"x", "y", "a", "psi", "phi"};
  for (int i = 0; i < N; i++) problem_label(made, i, "%s", label[i]);
  made->q[PSI] = 0.8;
  made->q[PHI] = 0.4;
  made->v[X] = 0.5;
  made->v[A] = -0.5 * tan(0.4) / own->r;
  made->v[PSI] = 1.0;
  made->v[PHI] = -0.6;

  const dvi_potential springs = {.name = "springs",
                                 .value = springs_potential,
                                 .gradient = springs_gradient,
                                 .hessian = springs_hessian,
                                 .qq = {spring_start, spring_row},
                                 .quadratic = 1,
                                 .user = own};
  const dvi_nonholonomic rows = {.name = "wheels",
                                 .count = 2,
                                 .value = wheels,
                                 .derivative = wheels_derivative,
                                 .transposed = {rows_start, rows_row},
                                 .by_q = {by_start, by_row},
                                 .user = own};
  const dvi_system_terms terms = {.dimension = N,
                                  .mass = {.values = own->mass, .pattern = {mass_start, mass_row}},
                                  .potentials = &springs,
                                  .potential_count = 1,
                                  .nonholonomics = &rows,
                                  .nonholonomic_count = 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

#define POSITIVE(letter, number, what)                                                       \
  {                                                                                          \
    .name = letter, .value = number, .least = 1e-50, .most = 1e50, .help = what ", positive" \
  }

static const problem_parameter parameters[] = {
    PROBLEM_MASS(1.0),
    POSITIVE("J", 0.2, "the moment of inertia of the board"),
    POSITIVE("Jr", 0.05, "the moment of inertia of the rider"),
    POSITIVE("Jw", 0.02, "the moment of inertia of an axle"),
    POSITIVE("k", 0.4, "the stiffness of the rider"),
    POSITIVE("kw", 0.3, "the stiffness of the axles"),
    POSITIVE("r", 0.3, "the distance of the axles from the centre"),
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.30225405289350199, 0.013583567651172638, -0.075150021810408626,
                                  0.41046788759462416, 0.20245917790211182};
static const double digits_p[] = {-0.44427938001126044, 0.03345059986089477, 0.20380357511085648,
                                  0.13063873986556915, 0.044767436551565162};

const problem_entry problem_entry_snakeboard = {
    .name = "snakeboard",
    .summary = "a snakeboard, two axles and a rider; nonholonomic",
    .parameters = parameters,
    .make = snakeboard_make,
    .h = 0.05,
    .t_end = 20.0,
    .order_h = 0.1,
    .order_t_end = 4.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
