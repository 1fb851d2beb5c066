/* Heavy bodies that turn about a fixed point. Their equations are those of Euler and Poisson.
 *
 *     Pi' = Pi x Omega + (R^T e3) x w,   R' = R Omega^
 *
 * pendulum-3d is a body that hangs from a pivot, with the centre of mass at l e3 in its frame,
 * gravity along +e3 of space, and V = -m g l R33. heavy-top has the centre of mass at l e2, its
 * inertia about that point, and J = J_com + m (|X|^2 I - X X^T) about the pivot, in kg, m, s.
 * kovalevskaya has J = (2,2,1), X along e1, and is the third integrable case. With G = R^T e3 and
 * the unit weight it conserves
 *
 *     |(Omega1 + i Omega2)^2 - (G1 + i G2)|^2.
 *
 * Sources: Leok and Shingel 2012, sec. 2.4 (pendulum-3d); Kovalevskaya 1889, Acta Math. 12:177. */
#include "bodies/top.h"

static dvi_status make_pendulum(const double *setting, problem *made)
{
  const dvi_status status = top_room(made, setting + 6);
  if (status != DVI_OK) return status;
  top *own = made->parameters;
  top_inertia(own, setting + 3);
  own->weight[2] = -setting[0] * setting[2] * setting[1];
  return top_system(made, NULL);
}

static dvi_status make_top(const double *setting, problem *made)
{
  const dvi_status status = top_room(made, setting + 3);
  if (status != DVI_OK) return status;
  top *own = made->parameters;
  const double m = setting[0], l = setting[1], g = setting[2];
  top_inertia(own, (double[]){0.234375 + m * l * l, 0.46875, 0.234375 + m * l * l});
  own->weight[1] = m * g * l;
  return top_system(made, NULL);
}

static int kovalevskaya_value(double t, const double *q, const double *p, double *I, void *user)
{
  const double weight = ((const top *)user)->weight[0], Omega1 = 0.5 * p[0], Omega2 = 0.5 * p[1];
  const double real = Omega1 * Omega1 - Omega2 * Omega2 - weight * q[6],
               imaginary = 2.0 * Omega1 * Omega2 - weight * q[7];
  (void)t;
  *I = real * real + imaginary * imaginary;
  return 0;
}

static dvi_status make_kovalevskaya(const double *setting, problem *made)
{
  const dvi_status status = top_room(made, setting + 1);
  if (status != DVI_OK) return status;
  top *own = made->parameters;
  top_inertia(own, (double[]){2.0, 2.0, 1.0});
  own->weight[0] = setting[0];
  const dvi_invariant invariant = {
      .name = "kovalevskaya", .value = kovalevskaya_value, .user = own};
  return top_system(made, &invariant);
}

static const problem_parameter pendulum_parameters[] = {
    PROBLEM_MASS(1.0),
    TOP_ARM(0.3),
    PROBLEM_GRAVITY(9.81),
    /* about the pivot */
    TOP_INERTIA("J1", 0.13),
    TOP_INERTIA("J2", 0.28),
    TOP_INERTIA("J3", 0.17),
    TOP_START("Omega1", 4.14),
    TOP_START("Omega2", 4.14),
    TOP_START("Omega3", 4.14),
    {.name = NULL},
};

static const problem_parameter top_parameters[] = {
    PROBLEM_MASS(15.0),
    TOP_ARM(1.0),
    PROBLEM_GRAVITY(9.81),
    TOP_START("Omega1", 0.0),
    TOP_START("Omega2", 150.0),
    TOP_START("Omega3", -4.61538),
    {.name = NULL},
};

static const problem_parameter kovalevskaya_parameters[] = {
    {.name = "weight", .value = 1.0, .least = 1e-50, .most = 1e50, .help = "m g |X|, positive"},
    TOP_START("Omega1", 0.5),
    TOP_START("Omega2", 1.0),
    TOP_START("Omega3", 1.5),
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double pendulum_digits_q[] = {
    -0.91094688055232031,  0.30657059823852456,  -0.27602581239382284,
    -0.020319793854638873, -0.70164896551149203, -0.71223299219732727,
    -0.41202292022374398,  -0.64319763486219861, 0.6453943877335564};
static const double pendulum_digits_p[] = {-0.87769160184370953, 0.041561708509644309,
                                           0.57159365308740806};

const problem_entry problem_entry_pendulum_3d = {
    .name = "pendulum-3d",
    .summary = "a rigid body that hangs from a pivot; rotations",
    .parameters = pendulum_parameters,
    .make = make_pendulum,
    .h = 0.01,
    .t_end = 10.0,
    .order_h = 0.02,
    .order_t_end = 1.0,
    .digits_q = pendulum_digits_q,
    .digits_p = pendulum_digits_p,
};

static const double top_digits_q[] = {
    0.2292996408036076,   0.17334396409838604, 0.95779619170155084,
    -0.76534074220468096, 0.64008859207056878, 0.067380580456872716,
    -0.60139439891715374, -0.7484907911335813, 0.27943928238402865};
static const double top_digits_p[] = {-12.52384608032245, 70.3125, -90.237641631475043};

const problem_entry problem_entry_heavy_top = {
    .name = "heavy-top",
    .summary = "a fast top under gravity; rotations",
    .parameters = top_parameters,
    .make = make_top,
    .h = 0.001,
    .t_end = 1.0,
    .order_h = 0.002,
    .order_t_end = 1.0,
    .digits_q = top_digits_q,
    .digits_p = top_digits_p,
};

static const double kovalevskaya_digits_q[] = {
    0.33219879765413118,   -0.94303267189375983, 0.018257562215857958,
    0.94302247719213284,   0.33245607953572426,  0.013474520034105529,
    -0.018776750186412238, 0.012741072193991497, 0.99974251621694299};
static const double kovalevskaya_digits_p[] = {1.2462333217864159, 1.8769053703135141,
                                               1.4998726178084483};

const problem_entry problem_entry_kovalevskaya = {
    .name = "kovalevskaya",
    .summary = "Kovalevskaya's top, the third integrable case; rotations",
    .parameters = kovalevskaya_parameters,
    .make = make_kovalevskaya,
    .h = 0.05,
    .t_end = 100.0,
    .order_h = 0.1,
    .order_t_end = 10.0,
    .digits_q = kovalevskaya_digits_q,
    .digits_p = kovalevskaya_digits_p,
};
