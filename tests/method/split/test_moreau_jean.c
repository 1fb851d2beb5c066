/* labels: unit order */
/* Contacts with friction at the level of velocities: blocks, disks and piles with known ends. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

static const double g = 9.81;

/* ---- bodies on floors ---- */

/* A constant force [n]. */
typedef struct load {
  int n;
  double force[3];
} load;

static int load_value(double t, const double *q, double *V, void *user)
{
  const load *l = user;
  (void)t;
  *V = 0;
  for (int i = 0; i < l->n; i++) *V -= l->force[i] * q[i];
  return 0;
}

static int load_gradient(double t, const double *q, double *V_q, void *user)
{
  const load *l = user;
  (void)t, (void)q;
  for (int i = 0; i < l->n; i++) V_q[i] = -l->force[i];
  return 0;
}

/* The last coordinate is the height above a floor. */
static int height(double t, const double *q, double *phi, void *user)
{
  (void)t;
  *phi = q[((const load *)user)->n - 1];
  return 0;
}

static int height_gradient(double t, const double *q, double *phi_q, void *user)
{
  (void)t, (void)q, (void)user;
  phi_q[0] = 1;
  return 0;
}

/* The slip of the other coordinates, one by one, or of the rim of a disk of radius 1 with x and its
 * turn, x' + a'. */
static int slip(double t, const double *q, double *T, void *user)
{
  (void)t, (void)q, (void)user;
  T[0] = T[1] = 1;
  return 0;
}

typedef struct body {
  load load;
  double mass[3];
  double restitution, friction;
  int rolls; /* a disk with the coordinates x, turn, height */
} body;

static dvi_system *create_body(body *b)
{
  static const int first[] = {0, 1}, last[] = {0, 1, 2}, rows[] = {0, 1, 2}, rim[] = {0, 2};
  const int n = b->load.n;
  const dvi_potential weight = {
      .value = load_value, .gradient = load_gradient, .quadratic = 1, .user = &b->load};
  const dvi_contact floor = {.name = "floor",
                             .gap = height,
                             .gradient = height_gradient,
                             .gradients = {first, rows + n - 1},
                             .restitution = b->restitution,
                             .friction = b->friction,
                             .tangent = b->friction > 0 ? slip : NULL,
                             .tangent_count = b->friction > 0 ? (b->rolls ? 1 : n - 1) : 0,
                             .tangents = {b->rolls ? rim : last, rows},
                             .user = &b->load};
  const dvi_system_terms terms = {.dimension = n,
                                  .mass = {.diagonal = b->mass},
                                  .potentials = &weight,
                                  .potential_count = 1,
                                  .contacts = &floor,
                                  .contact_count = 1};
  dvi_system *system;
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  return system;
}

static dvi_integrator *start_at(const dvi_system *system, const char *method, const double *q,
                                const double *v)
{
  dvi_integrator *integrator = create_integrator(system, method);
  ck_assert_int_eq(dvi_integrator_start_velocity(integrator, 0, q, v), DVI_OK);
  return integrator;
}

/* A block on a slope of 0.3 with friction 0.5. Its deceleration is constant, so that the path is
 * exact but for the step in which it stops. */
START_TEST(a_block_stops_at_its_place_and_stays_there)
{
  const double slope = 0.3, mu = 0.5, none[] = {0, 0}, v[] = {2, 0},
               slower = g * (mu * cos(slope) - sin(slope)), way = 1.11927419431935;
  body b = {.load = {2, {g * sin(slope), -g * cos(slope)}}, .mass = {1, 1}, .friction = mu};
  dvi_system *system = create_body(&b);
  for (double h = 0.04; h > 0.004; h /= 2) {
    dvi_integrator *integrator = start_at(system, "moreau-jean", none, v);
    advance(integrator, h, lround(1.2 / h));
    const double stopped = dvi_integrator_q(integrator)[0];
    ck_assert_double_eq(dvi_integrator_p(integrator)[0], 0);
    ck_assert_double_le(fabs(stopped - way), h * h * slower / 8 + 1e-14);
    advance(integrator, h, 1000);
    ck_assert_double_eq(dvi_integrator_q(integrator)[0], stopped);
    ck_assert_double_eq(dvi_integrator_q(integrator)[1], 0);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* The friction of a puck is against its velocity, whatever the axes: the cone is round. */
START_TEST(a_puck_slides_straight)
{
  const double none[] = {0, 0, 0}, v[] = {3, 4, 0}, way = 25 / (2 * 0.2 * g);
  body b = {.load = {3, {0, 0, -2 * g}}, .mass = {2, 2, 2}, .friction = 0.2};
  dvi_system *system = create_body(&b);
  dvi_integrator *integrator = start_at(system, "moreau-jean", none, v);
  advance(integrator, 0.01, 300);
  const double *q = dvi_integrator_q(integrator);
  ck_assert_double_eq_tol(q[0] * 4, q[1] * 3, 1e-12);
  ck_assert_double_eq_tol(hypot(q[0], q[1]), way, 1e-4 * 0.2 * g / 8 + 1e-12);
  ck_assert_double_le(magnitude(3, dvi_integrator_p(integrator)), 1e-14);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* A disk that starts without a turn slips until it rolls, with 2/3 of its speed. */
START_TEST(a_disk_ends_up_rolling)
{
  const double none[] = {0, 0, 0}, v[] = {3, 0, 0};
  body b = {.load = {3, {0, 0, -g}}, .mass = {1, 0.5, 1}, .friction = 0.3, .rolls = 1};
  dvi_system *system = create_body(&b);
  dvi_integrator *integrator = start_at(system, "moreau-jean", none, v);
  advance(integrator, 0.01, 100);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[0], 2, 1e-13);
  ck_assert_double_eq_tol(dvi_integrator_p(integrator)[1] / 0.5, -2, 1e-13);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

/* Up to the hit and from it on the path is exact. The hit itself is met by up to h/2 too early or
 * too late, which moves the ball by (1 + e) v h/2. */
START_TEST(a_hit_is_met_to_order_1)
{
  const double up = 1, none = 0, e = 0.8, fall = sqrt(2 / g), T = 0.8, speed = g * fall,
               after = T - fall, exact = e * speed * after - g / 2 * after * after;
  body b = {.load = {1, {-g}}, .mass = {1}, .restitution = e};
  dvi_system *system = create_body(&b);
  for (double h = 0.02; h > 0.0005; h /= 2) {
    dvi_integrator *integrator = start_at(system, "moreau-jean", &up, &none);
    advance(integrator, h, lround(T / h));
    ck_assert_double_le(fabs(dvi_integrator_q(integrator)[0] - exact),
                        (1 + e) * (speed + g * h) * h / 2 + g * h * h);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* Hits accumulate at 4.06. From then on the ball lies as deep in the floor as a step takes it. */
START_TEST(a_ball_comes_to_rest)
{
  const double up = 1, none = 0;
  body b = {.load = {1, {-g}}, .mass = {1}, .restitution = 0.8};
  dvi_system *system = create_body(&b);
  for (double h = 0.01; h > 0.001; h /= 2) {
    dvi_integrator *integrator = start_at(system, "moreau-jean", &up, &none);
    advance(integrator, h, lround(6 / h));
    ck_assert_double_le(fabs(dvi_integrator_p(integrator)[0]), 1e-15);
    ck_assert_double_le(fabs(dvi_integrator_q(integrator)[0]), 5 * h);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

/* ---- a pile of disks in a box ---- */

enum { DISKS = 20, COLUMNS = 4, PAIRS_MOST = DISKS * (DISKS - 1) / 2 + 3 * DISKS };
static const double radius = 0.5, box = 2.25;

/* Disk i against disk j > i, or against the floor, the left or the right wall, j = -1, -2, -3. */
typedef struct pair {
  int i, j, row[4], slip_row[6], end[2], slip_end[2];
} pair;
static pair pairs[PAIRS_MOST];

static int pair_gap(double t, const double *q, double *phi, void *user)
{
  const pair *c = user;
  const double *a = q + 3 * c->i;
  (void)t;
  if (c->j >= 0)
    *phi = hypot(a[0] - q[3 * c->j], a[1] - q[3 * c->j + 1]) - 2 * radius;
  else
    *phi = (c->j == -1 ? a[1] : c->j == -2 ? box + a[0] : box - a[0]) - radius;
  return 0;
}

static int pair_gradient(double t, const double *q, double *phi_q, void *user)
{
  const pair *c = user;
  (void)t;
  phi_q[0] = c->j == -3 ? -1 : 1;
  if (c->j < 0) return 0;
  const double dx = q[3 * c->i] - q[3 * c->j], dy = q[3 * c->i + 1] - q[3 * c->j + 1],
               d = hypot(dx, dy);
  phi_q[0] = dx / d, phi_q[1] = dy / d;
  phi_q[2] = -phi_q[0], phi_q[3] = -phi_q[1];
  return 0;
}

static int pair_tangent(double t, const double *q, double *T, void *user)
{
  const pair *c = user;
  (void)t;
  T[0] = 1;
  T[1] = c->j == -2 ? -radius : radius;
  if (c->j < 0) return 0;
  const double dx = q[3 * c->i] - q[3 * c->j], dy = q[3 * c->i + 1] - q[3 * c->j + 1],
               d = hypot(dx, dy);
  T[0] = -dy / d, T[1] = dx / d, T[2] = -radius;
  T[3] = -T[0], T[4] = -T[1], T[5] = -radius;
  return 0;
}

static dvi_contact contact_of(pair *c, int i, int j, double restitution, double friction)
{
  const int wall = j < 0, axis = j == -1 ? 1 : 0;
  *c = (pair){.i = i, .j = j, .end = {0, wall ? 1 : 4}, .slip_end = {0, wall ? 2 : 6}};
  for (int a = 0; a < 4; a++) c->row[a] = wall ? 3 * i + axis : 3 * (a < 2 ? i : j) + a % 2;
  for (int a = 0; a < 6; a++) c->slip_row[a] = 3 * (a < 3 ? i : j) + a % 3;
  if (wall) c->slip_row[0] = 3 * i + 1 - axis, c->slip_row[1] = 3 * i + 2;
  return (dvi_contact){.name = "touch",
                       .gap = pair_gap,
                       .gradient = pair_gradient,
                       .gradients = {c->end, c->row},
                       .tangent = pair_tangent,
                       .tangent_count = 1,
                       .tangents = {c->slip_end, c->slip_row},
                       .restitution = restitution,
                       .friction = friction,
                       .user = c};
}

static int pile_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0;
  for (int i = 0; i < DISKS; i++) *V += g * q[3 * i + 1];
  return 0;
}

static int pile_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  for (int i = 0; i < 3 * DISKS; i++) V_q[i] = i % 3 == 1 ? g : 0;
  return 0;
}

static dvi_system *create_pile(double restitution, double friction)
{
  static dvi_contact contacts[PAIRS_MOST];
  const dvi_potential weight = {.value = pile_value, .gradient = pile_gradient};
  double mass[3 * DISKS];
  dvi_system *system;
  int count = 0;
  for (int i = 0; i < DISKS; i++) {
    for (int j = -3; j < DISKS; j++)
      if (j < 0 || j > i) {
        contacts[count] = contact_of(&pairs[count], i, j, restitution, friction);
        count++;
      }
    mass[3 * i] = mass[3 * i + 1] = 1, mass[3 * i + 2] = radius * radius / 2;
  }
  const dvi_system_terms terms = {.dimension = 3 * DISKS,
                                  .mass = {.diagonal = mass},
                                  .potentials = &weight,
                                  .potential_count = 1,
                                  .contacts = contacts,
                                  .contact_count = count};
  ck_assert_int_eq(dvi_system_create(&terms, &system), DVI_OK);
  return system;
}

static dvi_integrator *start_pile(const dvi_system *system)
{
  double q[3 * DISKS], v[3 * DISKS] = {0};
  for (int i = 0; i < DISKS; i++) {
    q[3 * i] = (i % COLUMNS - 1.5) * 1.1 + 0.02 * sin(7 * i);
    q[3 * i + 1] = 0.6 + 1.1 * (i / COLUMNS);
    q[3 * i + 2] = 0;
  }
  ck_assert_int_eq(dvi_system_check(system, 0, q, v, 0, NULL), DVI_OK);
  return start_at(system, "moreau-jean", q, v);
}

/* Disks penetrate each other by what they fall in a step at most, times some constant. */
START_TEST(a_pile_comes_to_rest_with_small_penetration)
{
  dvi_system *system = create_pile(0, 0.3);
  for (double h = 0.02; h > 0.004; h /= 2) {
    dvi_integrator *integrator = start_pile(system);
    double gap, least = 0;
    for (int i = 0; i < lround(3 / h); i++) {
      advance(integrator, h, 1);
      ck_assert_int_eq(dvi_integrator_gap(integrator, &gap, NULL), DVI_OK);
      least = fmin(least, gap);
    }
    ck_assert_double_ge(least, -5 * h);
    ck_assert_double_le(magnitude(3 * DISKS, dvi_integrator_p(integrator)), 1e-6);
    dvi_integrator_destroy(&integrator);
  }
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(a_restored_pile_has_the_same_bits_and_no_step_takes_memory)
{
  static char bytes[65536];
  size_t size;
  dvi_counters before, after;
  dvi_system *system = create_pile(0.2, 0.3);
  dvi_integrator *integrator = start_pile(system),
                 *other = create_integrator(system, "moreau-jean");
  advance(integrator, 0.01, 50);
  ck_assert_int_eq(dvi_integrator_save_memory(integrator, bytes, sizeof bytes, &size), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore_memory(other, bytes, size), DVI_OK);
  dvi_integrator_counters(integrator, &before);
  advance(integrator, 0.01, 30);
  dvi_integrator_counters(integrator, &after);
  advance(other, 0.01, 30);
  ck_assert_int_eq(after.allocations, before.allocations);
  ck_assert_int_gt(after.sweeps, before.sweeps);
  ck_assert_int_eq(
      memcmp(dvi_integrator_q(integrator), dvi_integrator_q(other), 3 * DISKS * sizeof(double)), 0);
  dvi_integrator_destroy(&integrator);
  dvi_integrator_destroy(&other);
  dvi_system_destroy(&system);
}
END_TEST

/* ---- balances, refusals ---- */

START_TEST(balances_count_friction_and_hits)
{
  const double q[] = {0, 1}, v[] = {2, 0};
  body b = {.load = {2, {0, -g}}, .mass = {1, 1}, .friction = 0.2, .restitution = 0.5};
  dvi_system *system = create_body(&b);
  const dvi_integrator_options options = {
      .size = sizeof options, .method = "moreau-jean", .balances = 1};
  dvi_integrator *integrator;
  double defect, energy;
  ck_assert_int_eq(dvi_integrator_create_with(system, &options, &integrator), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, v), DVI_OK);
  advance(integrator, 0.01, 400);
  ck_assert_int_eq(dvi_integrator_balance(integrator, 0, &defect), DVI_OK);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &energy), DVI_OK);
  ck_assert_double_le(fabs(defect), 1e-13);
  ck_assert_double_eq_tol(dvi_integrator_supplied(integrator, 0), energy - g - 2, 1e-13);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
}
END_TEST

START_TEST(what_it_cannot_take_is_refused)
{
  const double up = 1, none = 0, below = -1;
  dvi_integrator *integrator;
  body b = {.load = {1, {-g}}, .mass = {1}, .restitution = 1};
  dvi_system *system = create_body(&b);
  ck_assert_int_eq(dvi_integrator_create(system, "moreau-jean:theta=0.4", &integrator),
                   DVI_BAD_OPTION);
  check_words("0.5 to 1");
  integrator = start_at(system, "moreau-jean:theta=1", &up, &none);
  ck_assert_int_eq(dvi_integrator_step(integrator, -0.1), DVI_BAD_ARGUMENT);
  check_words("cannot be undone");
  ck_assert_double_eq(*dvi_integrator_q(integrator), 1);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, &below, &none), DVI_BAD_ARGUMENT);
  check_words("contact 'floor' is -1 at the start");
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  b.friction = 0.1;
  b.load.n = 2;
  b.mass[1] = 1;
  system = create_body(&b);
  ck_assert_int_eq(dvi_integrator_create(system, "verlet", &integrator), DVI_UNSUPPORTED);
  check_words("contacts with friction");
  check_words("moreau-jean");
  dvi_system_destroy(&system);
}
END_TEST

SUITE(moreau_jean)
{
  tcase_add_test(tests, a_block_stops_at_its_place_and_stays_there);
  tcase_add_test(tests, a_puck_slides_straight);
  tcase_add_test(tests, a_disk_ends_up_rolling);
  tcase_add_test(tests, a_hit_is_met_to_order_1);
  tcase_add_test(tests, a_ball_comes_to_rest);
  tcase_add_test(tests, a_pile_comes_to_rest_with_small_penetration);
  tcase_add_test(tests, a_restored_pile_has_the_same_bits_and_no_step_takes_memory);
  tcase_add_test(tests, balances_count_friction_and_hits);
  tcase_add_test(tests, what_it_cannot_take_is_refused);
}
