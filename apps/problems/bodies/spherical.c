/* Pendula that swing in all directions, q_i on the sphere S^2, gravity along +z.
 *
 * spherical-double-pendulum has m l^2 (2 |q1'|^2 + 2 q1'.q2' + |q2'|^2)/2 + m g l (2 z1 + z2). One
 * pendulum hangs on the other, and the mass couples them. spherical-chain has |q_i'|^2/2 for each
 * of n, and V = - g sum z_i + k/2 sum |q_{i+1} - q_i|^2. Only springs couple neighbours, so that
 * the Hessian is sparse. It starts at rest, at the angle a from the vertical, once round along the
 * chain. Source: Lee, Leok and McClamroch 2009, Int. J. Numer. Meth. Engng 79:1147. */
#include <math.h>

#include "entry.h"

/* Springs and weights, V = - sum_i weight_i z_i + k/2 sum |q_{i+1} - q_i|^2. */
typedef struct pendula {
  int n;
  double k;
  double *weight;
  int *start, *row; /* pattern of the Hessian */
  double *mass;     /* mass of the double pendulum */
} pendula;

static int pendula_potential(int count, const double *t, const double *q, double *V, void *user)
{
  const pendula *own = user;
  (void)t;
  memset(V, 0, (size_t)count * sizeof *V);
  for (int i = 0; i < own->n; i++) {
    const double *restrict z = q + (ptrdiff_t)(3 * i + 2) * count;
    for (int k = 0; k < count; k++) V[k] -= own->weight[i] * z[k];
  }
  for (int j = 0; j < 3 * (own->n - 1); j++) {
    const double *restrict here = q + (ptrdiff_t)j * count, *restrict next = here +
                                                                             (ptrdiff_t)3 * count;
    for (int k = 0; k < count; k++)
      V[k] += 0.5 * own->k * (next[k] - here[k]) * (next[k] - here[k]);
  }
  return 0;
}

static int pendula_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const pendula *own = user;
  (void)t;
  for (int j = 0; j < 3 * own->n; j++)
    for (int k = 0; k < count; k++) V_q[j * count + k] = j % 3 == 2 ? -own->weight[j / 3] : 0.0;
  for (int j = 0; j < 3 * (own->n - 1); j++) {
    const double *restrict here = q + (ptrdiff_t)j * count, *restrict next = here +
                                                                             (ptrdiff_t)3 * count;
    double *restrict V_here = V_q + (ptrdiff_t)j * count, *restrict V_next = V_here +
                                                                             (ptrdiff_t)3 * count;
    for (int k = 0; k < count; k++) {
      const double force = own->k * (next[k] - here[k]);
      V_here[k] -= force;
      V_next[k] += force;
    }
  }
  return 0;
}

/* Fill the constant Hessian. Its diagonal has as many springs as a pendulum has neighbours, with -k
 * beside it. */
static int pendula_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const pendula *own = user;
  (void)t, (void)q;
  for (int j = 0; j < 3 * own->n; j++)
    for (int e = own->start[j]; e < own->start[j + 1]; e++)
      for (int k = 0; k < count; k++)
        V_qq[(ptrdiff_t)e * count + k] = own->row[e] != j
                                             ? -own->k
                                             : own->k * (own->start[j + 1] - own->start[j] - 1);
  return 0;
}

/* Fill the pattern. Column j has the pendula i - 1, i, i + 1 with the same component. */
static void pendula_fill_pattern(const pendula *own)
{
  int e = 0;
  for (int j = 0; j < 3 * own->n; j++) {
    own->start[j] = e;
    for (int row = j - 3; row <= j + 3; row += 3)
      if (row >= 0 && row < 3 * own->n) own->row[e++] = row;
  }
  own->start[3 * own->n] = e;
}

/* Turn all pendula about the vertical, z x q. */
static int pendula_turn(const double *q, double *xi, void *user)
{
  const pendula *own = user;
  for (int i = 0; i < 3 * own->n; i += 3) {
    xi[i] = -q[i + 1];
    xi[i + 1] = q[i];
    xi[i + 2] = 0.0;
  }
  return 0;
}

/* Allocate memory for n pendula, their factors of this inertia, and their pattern. */
static dvi_status pendula_allocate(problem *made, int n, double inertia, dvi_factor **factors)
{
  *factors = problem_allocate(made, (size_t)n, sizeof **factors);
  if (!*factors) return DVI_NO_MEMORY;
  for (int i = 0; i < n; i++) (*factors)[i] = (dvi_factor){.kind = DVI_S2, .mass = inertia};
  const dvi_status status = problem_factors(made, n, *factors, sizeof(pendula));
  if (status != DVI_OK) return status;
  pendula *own = made->parameters;
  own->n = n;
  own->weight = problem_allocate(made, (size_t)n, sizeof *own->weight);
  own->start = problem_allocate(made, 3 * (size_t)n + 1, sizeof *own->start);
  own->row = problem_allocate(made, 9 * (size_t)n, sizeof *own->row);
  if (!own->weight || !own->start || !own->row) return DVI_NO_MEMORY;
  pendula_fill_pattern(own);
  return DVI_OK;
}

static dvi_status pendula_make_system(problem *made, const dvi_factor *factors, dvi_mass mass)
{
  pendula *own = made->parameters;
  const dvi_potential potential = {.name = "gravity and springs",
                                   .value_batch = pendula_potential,
                                   .gradient_batch = pendula_gradient,
                                   .hessian_batch = pendula_hessian,
                                   .qq = {own->start, own->row},
                                   .user = own};
  const dvi_symmetry symmetry = {
      .name = "angular_momentum_z", .generator = pendula_turn, .user = own};
  const dvi_system_terms terms = {.factors = factors,
                                  .factor_count = own->n,
                                  .mass = mass,
                                  .potentials = &potential,
                                  .potential_count = 1,
                                  .symmetries = &symmetry,
                                  .symmetry_count = 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

/* Compute v = omega x q. */
static void spherical_velocity(const double *omega, const double *q, double *v)
{
  for (int i = 0; i < 3; i++)
    v[i] = omega[(i + 1) % 3] * q[(i + 2) % 3] - omega[(i + 2) % 3] * q[(i + 1) % 3];
}

static dvi_status spherical_make_double(const double *setting, problem *made)
{
  static const double omega[2][3] = {{-0.433, 0.0, 0.75}, {0.0, 1.0, 0.0}};
  dvi_factor *factors;
  const dvi_status status = pendula_allocate(made, 2, 0.0, &factors);
  if (status != DVI_OK) return status;
  pendula *own = made->parameters;
  const double m = setting[0], l = setting[1], g = setting[2],
               length = sqrt(0.866 * 0.866 + 0.5 * 0.5);
  own->mass = problem_allocate(made, 12, sizeof *own->mass);
  if (!own->mass) return DVI_NO_MEMORY;
  for (int j = 0; j < 12; j++) own->mass[j] = j < 6 && j % 2 == 0 ? 2.0 * m * l * l : m * l * l;
  own->weight[0] = 2.0 * m * g * l;
  own->weight[1] = m * g * l;
  made->q[0] = 0.866 / length;
  made->q[2] = 0.5 / length;
  made->q[5] = 1.0;
  for (int i = 0; i < 6; i += 3) spherical_velocity(omega[i / 3], made->q + i, made->v + i);
  return pendula_make_system(made, factors,
                             (dvi_mass){.values = own->mass, .pattern = {own->start, own->row}});
}

static dvi_status spherical_make_chain(const double *setting, problem *made)
{
  const int n = (int)setting[0];
  dvi_factor *factors;
  const dvi_status status = pendula_allocate(made, n, 1.0, &factors);
  if (status != DVI_OK) return status;
  pendula *own = made->parameters;
  own->k = setting[1];
  for (int i = 0; i < n; i++) {
    const double round = 6.28318530717958648 * i / n;
    own->weight[i] = setting[2];
    made->q[3 * i] = sin(setting[3]) * cos(round);
    made->q[3 * i + 1] = sin(setting[3]) * sin(round);
    made->q[3 * i + 2] = cos(setting[3]);
  }
  return pendula_make_system(made, factors, (dvi_mass){0});
}

static const problem_parameter double_parameters[] = {
    {.name = "m", .value = 0.1, .least = 1e-50, .most = 1e50, .help = "each mass, positive"},
    {.name = "l", .value = 0.1, .least = 1e-50, .most = 1e50, .help = "each length, positive"},
    PROBLEM_GRAVITY(9.81),
    {.name = NULL},
};

static const problem_parameter chain_parameters[] = {
    {.name = "n",
     .value = 8.0,
     .least = 1.0,
     .most = 1e6,
     .whole = 1,
     .help = "how many pendula, a whole number from 1 to 1e6"},
    {.name = "k",
     .value = 1.0,
     .least = 0.0,
     .most = 1e50,
     .help = "the springs' stiffness, from 0"},
    PROBLEM_GRAVITY(1.0),
    {.name = "a",
     .value = 0.5,
     .least = -3.2,
     .most = 3.2,
     .start_only = 1,
     .help = "the angle from the vertical at the start"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double double_digits_q[] = {0.46250651653439634, 0.11725857616840518,
                                         0.87882771262527704, -0.12092334248324678,
                                         0.17487264485413442, 0.97713719779998098};
static const double double_digits_p[] = {-0.014149547115099687,   -0.0019368766442725035,
                                         0.0077050063931615557,   -0.0035388204405951604,
                                         -0.00097414963940879132, -0.00026360051871693384};

const problem_entry problem_entry_spherical_double_pendulum = {
    .name = "spherical-double-pendulum",
    .summary =
        "two masses on two rods that swing in all directions; directions, coupled by their mass",
    .parameters = double_parameters,
    .make = spherical_make_double,
    .h = 0.005,
    .t_end = 10.0,
    .order_h = 0.01,
    .order_t_end = 1.0,
    .digits_q = double_digits_q,
    .digits_p = double_digits_p,
};

static const double chain_digits_q[] = {
    0.44550754251153685,  0.062979299618785123, 0.89306026525921445,   0.26315007597599088,
    0.10633715274483123,  0.95887665914858555,  -0.058194240639614987, 0.2864534413854985,
    0.95632518333189542,  -0.34996696668307986, 0.29007110093250105,   0.89071986540912562,
    -0.45257525782851127, 0.042352772837273379, 0.89071986540912562,   -0.24370271308018274,
    -0.16140362871563568, 0.95632518333189542,  0.1108834813944385,    -0.26126692499031823,
    0.95887665914858555,  0.27048831454483951,  -0.35955449421448415,  0.89306026525921445};
static const double chain_digits_p[] = {
    0.16710042015453355,   0.59586952005996896,   -0.12538005208500649,  0.11026296125363481,
    0.34526041372020705,   -0.068548666144511591, -0.04607645557900749,  -0.035066986862663387,
    0.0076999694773164989, -0.090021159105311485, -0.033086674369940387, -0.024594650663409986,
    -0.040258760239742883, 0.087050383867534858,  -0.024594650663409986, -0.0077848699865880732,
    0.057377078399325779,  0.0076999694773164989, -0.16616829220067661,  -0.32210366743298602,
    -0.068548666144511591, -0.30318553810638565,  -0.53950121856716948,  -0.12538005208500649};

const problem_entry problem_entry_spherical_chain = {
    .name = "spherical-chain",
    .summary = "n spherical pendula with springs between neighbours; directions, sparse",
    .parameters = chain_parameters,
    .make = spherical_make_chain,
    .h = 0.05,
    .t_end = 100.0,
    .order_h = 0.1,
    .order_t_end = 5.0,
    .digits_q = chain_digits_q,
    .digits_p = chain_digits_p,
};
