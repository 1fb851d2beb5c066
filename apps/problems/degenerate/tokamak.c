/* The guiding centre of a particle in a tokamak, in cylindrical coordinates (R, Z, phi) with the
 * velocity u along the field.
 *
 *     alpha = A + u b,  A = ( Z/(2R), -ln(R)/2, r^2/4 ),  r^2 = (R-1)^2 + Z^2,
 *     H = u^2/2 + mu |B|,
 *     |B| = sqrt(N)/(2R),  b = ( -Z, R-1, 2R )/sqrt(N),  N = r^2 + 4.
 *
 * |B| is the field's strength, and b its direction in covariant components. Sources: Qin, Guan and
 * Tang 2009, Phys. Plasmas 16:042510, and Kraus 2017, arXiv:1708.07356. */
#include <math.h>

#include "entry.h"

enum { R, Z, PHI, U };

/* f = N^(-1/2) and its derivatives. */
typedef struct root {
  double f, f_R, f_Z, f_RR, f_RZ, f_ZZ;
} root;

static root tokamak_root(const double *q)
{
  const double x = q[R] - 1, z = q[Z], f = 1 / sqrt(x * x + z * z + 4), f3 = f * f * f,
               f5 = f3 * f * f;
  return (root){.f = f,
                .f_R = -x * f3,
                .f_Z = -z * f3,
                .f_RR = 3 * x * x * f5 - f3,
                .f_RZ = 3 * x * z * f5,
                .f_ZZ = 3 * z * z * f5 - f3};
}

static int tokamak_one_form(const double *q, double *alpha, void *user)
{
  const double x = q[R] - 1, z = q[Z], u = q[U];
  (void)user;
  if (!(q[R] > 0)) return 1;
  const root g = tokamak_root(q);
  alpha[R] = 0.5 * z / q[R] - u * z * g.f;
  alpha[Z] = -0.5 * log(q[R]) + u * x * g.f;
  alpha[PHI] = 0.25 * (x * x + z * z) + 2 * u * q[R] * g.f;
  alpha[U] = 0;
  return 0;
}

/* Columns R, Z and phi hold the derivatives in R, Z and u. */
static const int gradient_start[] = {0, 3, 6, 9, 9}, gradient_row[] = {R, Z, U, R, Z, U, R, Z, U};

static int tokamak_one_form_gradient(const double *q, double *alpha_q, void *user)
{
  const double x = q[R] - 1, z = q[Z], u = q[U], rr = q[R] * q[R];
  (void)user;
  if (!(q[R] > 0)) return 1;
  const root g = tokamak_root(q);
  alpha_q[0] = -0.5 * z / rr - u * z * g.f_R;
  alpha_q[1] = 0.5 / q[R] - u * (g.f + z * g.f_Z);
  alpha_q[2] = -z * g.f;
  alpha_q[3] = -0.5 / q[R] + u * (g.f + x * g.f_R);
  alpha_q[4] = u * x * g.f_Z;
  alpha_q[5] = x * g.f;
  alpha_q[6] = 0.5 * x + 2 * u * (g.f + q[R] * g.f_R);
  alpha_q[7] = 0.5 * z + 2 * u * q[R] * g.f_Z;
  alpha_q[8] = 2 * q[R] * g.f;
  return 0;
}

/* All derivatives in R, Z and u except the one in u alone. */
static const int hessian_start[] = {0, 3, 6, 6, 8}, hessian_row[] = {R, Z, U, R, Z, U, R, Z};

static int tokamak_one_form_hessian(const double *q, const double *w, double *alpha_w_qq,
                                    void *user)
{
  const double x = q[R] - 1, z = q[Z], u = q[U], rr = q[R] * q[R];
  (void)user;
  if (!(q[R] > 0)) return 1;
  const root g = tokamak_root(q);
  /* b(q).w = b f */
  const double b = -w[R] * z + w[Z] * x + 2 * w[PHI] * q[R], b_R = w[Z] + 2 * w[PHI], b_Z = -w[R];
  alpha_w_qq[0] = w[R] * z / (rr * q[R]) + w[Z] * 0.5 / rr + 0.5 * w[PHI] +
                  u * (2 * b_R * g.f_R + b * g.f_RR);
  alpha_w_qq[1] = alpha_w_qq[3] = -0.5 * w[R] / rr + u * (b_R * g.f_Z + b_Z * g.f_R + b * g.f_RZ);
  alpha_w_qq[2] = alpha_w_qq[6] = b_R * g.f + b * g.f_R;
  alpha_w_qq[4] = 0.5 * w[PHI] + u * (2 * b_Z * g.f_Z + b * g.f_ZZ);
  alpha_w_qq[5] = alpha_w_qq[7] = b_Z * g.f + b * g.f_Z;
  return 0;
}

static const double mu = 2.25e-6;

static int tokamak_hamiltonian(double t, const double *q, double *value_of_H, void *user)
{
  (void)t, (void)user;
  if (!(q[R] > 0)) return 1;
  *value_of_H = 0.5 * q[U] * q[U] + 0.5 * mu / (q[R] * tokamak_root(q).f);
  return 0;
}

/* Evaluate the gradient. |B| = N f/(2R) with N_R = 2 x, N_Z = 2 z. */
static int tokamak_gradient(double t, const double *q, double *H_q, void *user)
{
  const double x = q[R] - 1, z = q[Z];
  (void)t, (void)user;
  if (!(q[R] > 0)) return 1;
  const root g = tokamak_root(q);
  H_q[R] = 0.5 * mu * (x * g.f / q[R] - 1 / (g.f * q[R] * q[R]));
  H_q[Z] = 0.5 * mu * z * g.f / q[R];
  H_q[PHI] = 0;
  H_q[U] = q[U];
  return 0;
}

static const int H_start[] = {0, 2, 4, 4, 5}, H_row[] = {R, Z, R, Z, U};

static int tokamak_hessian(double t, const double *q, double *H_qq, void *user)
{
  const double x = q[R] - 1, z = q[Z], rr = q[R] * q[R];
  (void)t, (void)user;
  if (!(q[R] > 0)) return 1;
  const root g = tokamak_root(q);
  H_qq[0] = 0.5 * mu * ((g.f + x * g.f_R) / q[R] - 2 * x * g.f / rr + 2 / (g.f * rr * q[R]));
  H_qq[1] = H_qq[2] = 0.5 * mu * (x * g.f_Z / q[R] - z * g.f / rr);
  H_qq[3] = 0.5 * mu * (g.f + z * g.f_Z) / q[R];
  H_qq[4] = 1;
  return 0;
}

static int tokamak_rotation(const double *q, double *xi, void *user)
{
  (void)q, (void)user;
  xi[R] = xi[Z] = xi[U] = 0;
  xi[PHI] = 1;
  return 0;
}

static dvi_status tokamak_make(const double *setting, problem *made)
{
  static const double start[] = {1.05, 0, 0, 4.306e-4};
  (void)setting;
  const dvi_status status = problem_room(made, 4, 1);
  if (status != DVI_OK) return status;
  memcpy(made->q, start, sizeof start);
  problem_label(made, R, "R");
  problem_label(made, Z, "Z");
  problem_label(made, PHI, "phi");
  problem_label(made, U, "u");

  const dvi_one_form form = {.value = tokamak_one_form,
                             .gradient = tokamak_one_form_gradient,
                             .hessian = tokamak_one_form_hessian,
                             .gradients = {gradient_start, gradient_row},
                             .qq = {hessian_start, hessian_row}};
  const dvi_potential hamiltonian = {.name = "H",
                                     .value = tokamak_hamiltonian,
                                     .gradient = tokamak_gradient,
                                     .hessian = tokamak_hessian,
                                     .qq = {H_start, H_row}};
  const dvi_symmetry symmetry = {.name = "toroidal_momentum", .generator = tokamak_rotation};
  return problem_one_form_system(made, &form, &hamiltonian, 1, &symmetry);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {1.0601217266130805, 0.051963151457281823, 0.85390508788519182,
                                  -0.00047362945138384435};
static const double digits_p[] = {0.024520402012874389, -0.029206095464070679,
                                  0.0010769887755705046, 0};

const problem_entry problem_entry_tokamak = {
    .name = "tokamak",
    .summary = "the guiding centre of a particle on a banana orbit in a tokamak; degenerate",
    .make = tokamak_make,
    .h = 500.0,
    .t_end = 500000.0,
    .order_h = 400.0,
    .order_t_end = 16000.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
