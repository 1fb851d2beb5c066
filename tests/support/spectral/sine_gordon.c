#include "support/spectral/sine_gordon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/suite.h"

static const double pi = 3.14159265358979323846;

typedef struct pull {
  const sine_gordon *of;
  double strength;
} pull;

static double square(double x)
{
  return x * x;
}

static double wave_number(int i)
{
  return ceil(i / 2.0);
}

/* ---- stretch, pi k^2 (c_k^2 + s_k^2)/2 ---- */

static int stretch_value(double t, const double *q, double *V, void *user)
{
  const sine_gordon *own = user;
  (void)t;
  *V = 0;
  for (int i = 0; i < own->n; i++) *V += pi * square(wave_number(i) * q[i]) / 2;
  return 0;
}

static int stretch_gradient(double t, const double *q, double *V_q, void *user)
{
  const sine_gordon *own = user;
  (void)t;
  for (int i = 0; i < own->n; i++) V_q[i] = pi * square(wave_number(i)) * q[i];
  return 0;
}

static int stretch_hessian(double t, const double *q, double *V_qq, void *user)
{
  const sine_gordon *own = user;
  (void)t, (void)q;
  for (int i = 0; i < own->n; i++) V_qq[i] = pi * square(wave_number(i));
  return 0;
}

/* ---- pull, 1 - cos u at M points ---- */

static void fill_values(const sine_gordon *own, const double *q)
{
  memset(own->values, 0, (size_t)own->M * sizeof(double));
  memcpy(own->values, q, (size_t)own->n * sizeof(double));
  dvi__fft_synthesise(own->fft, own->values, own->work);
}

static int pull_value(double t, const double *q, double *V, void *user)
{
  const pull *own = user;
  (void)t;
  fill_values(own->of, q);
  *V = 0;
  for (int j = 0; j < own->of->M; j++) *V += 2 * square(sin(own->of->values[j] / 2));
  *V *= own->strength * 2 * pi / own->of->M;
  return 0;
}

static int pull_gradient(double t, const double *q, double *V_q, void *user)
{
  const pull *own = user;
  (void)t;
  fill_values(own->of, q);
  for (int j = 0; j < own->of->M; j++) own->of->values[j] = sin(own->of->values[j]);
  dvi__fft_analyse(own->of->fft, own->of->values, own->of->work);
  for (int i = 0; i < own->of->n; i++)
    V_q[i] = own->strength * 2 * pi / own->of->M * own->of->values[i];
  return 0;
}

/* No Hessian is to be formed of it. */
static int refuse_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)V_qq, (void)user;
  ck_abort_msg("the Hessian of a potential that is declared without one");
}

/* ---- system ---- */

static int translate(const double *q, double *xi, void *user)
{
  const sine_gordon *own = user;
  xi[0] = 0;
  for (int i = 1; i < own->n; i += 2) {
    xi[i] = wave_number(i) * q[i + 1];
    xi[i + 1] = -wave_number(i) * q[i];
  }
  return 0;
}

static void create_system(sine_gordon *own, pull *pulled, int without_hessian)
{
  int start[2 * SINE_GORDON_MODES + 2], row[2 * SINE_GORDON_MODES + 1];
  for (int i = 0; i <= own->n; i++) start[i] = i;
  for (int i = 0; i < own->n; i++) row[i] = i;
  const dvi_potential potentials[] = {{.name = "stretch",
                                       .value = stretch_value,
                                       .gradient = stretch_gradient,
                                       .hessian = stretch_hessian,
                                       .qq = {start, row},
                                       .quadratic = 1,
                                       .fast = 1,
                                       .user = own},
                                      {.name = "pull",
                                       .value = pull_value,
                                       .gradient = pull_gradient,
                                       .hessian = without_hessian ? refuse_hessian : NULL,
                                       .without_hessian = without_hessian,
                                       .user = pulled}};
  const dvi_symmetry symmetry = {.name = "momentum", .generator = translate, .user = own};
  ck_assert_int_eq(dvi_system_create(&(dvi_system_terms){.dimension = own->n,
                                                         .mass.diagonal = own->mass,
                                                         .potentials = potentials,
                                                         .potential_count = 2,
                                                         .symmetries = &symmetry,
                                                         .symmetry_count = 1,
                                                         .autonomous = 1},
                                     &own->system),
                   DVI_OK);
}

void sine_gordon_create(int K, int M, double strength, int without_hessian, sine_gordon *made)
{
  ck_assert_int_le(K, SINE_GORDON_MODES);
  ck_assert_int_ge(M, 2 * K + 1);
  *made = (sine_gordon){.n = 2 * K + 1, .M = M};
  ck_assert_int_eq(dvi__fft_create(M, &made->fft), DVI_OK);
  made->values = malloc((size_t)M * sizeof(double));
  made->work = malloc((size_t)dvi__fft_work(made->fft) * sizeof(double));
  made->pull = malloc(sizeof(pull));
  *(pull *)made->pull = (pull){made, strength};
  for (int i = 0; i < made->n; i++) made->mass[i] = i == 0 ? 2 * pi : pi;
  made->q[0] = 1.5;
  made->q[1] = 0.5;
  made->p[2] = 0.3 * made->mass[2];
  create_system(made, made->pull, without_hessian);
}

void sine_gordon_destroy(sine_gordon *made)
{
  dvi_system_destroy(&made->system);
  dvi__fft_destroy(&made->fft);
  free(made->values);
  free(made->work);
  free(made->pull);
}
