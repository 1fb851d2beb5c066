/* labels: unit */
/* Boris's method: volume, energy, the way back. Its orders are in method/order_magnetic. */
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"
#include "support/systems/magnetic.h"

static dvi_integrator *started(const magnetic *m, const char *method)
{
  double p[MAGNETIC_N];
  dvi_integrator *integrator = create_integrator(m->system, method);
  ck_assert_int_eq(dvi_system_momentum(m->system, 0, m->q, m->v, p), DVI_OK);
  ck_assert_msg(dvi_integrator_start(integrator, 0, m->q, p) == DVI_OK, "%s", dvi_last_error());
  return integrator;
}

/* Gives the largest distance of q and v of a state from these. */
static double distance_from(const magnetic *m, double t, const double *q, const double *p,
                            const double *q_end, const double *v_end)
{
  double v[MAGNETIC_N] = {0}, error = 0;
  ck_assert_int_eq(dvi_system_velocity(m->system, t, q, p, v), DVI_OK);
  for (int i = 0; i < m->n; i++)
    error = fmax(error, fmax(fabs(q[i] - q_end[i]), fabs(v[i] - v_end[i])));
  return error;
}

static double determinant(int n, double *A)
{
  double product = 1;
  for (int k = 0; k < n; k++) {
    int pivot = k;
    for (int i = k; i < n; i++)
      if (fabs(A[i * n + k]) > fabs(A[pivot * n + k])) pivot = i;
    for (int j = 0; j < n && pivot != k; j++) {
      const double kept = A[k * n + j];
      A[k * n + j] = A[pivot * n + j];
      A[pivot * n + j] = kept;
    }
    product *= pivot == k ? A[k * n + k] : -A[k * n + k];
    for (int i = k + 1; i < n; i++)
      for (int j = n - 1; j >= k; j--) A[i * n + j] -= A[i * n + k] / A[k * n + k] * A[k * n + j];
  }
  return product;
}

/* The derivative of a step by central differences of fourth order. */
START_TEST(boris_preserves_the_volume_and_is_not_symplectic)
{
  enum { SIZE = 6 };
  magnetic m;
  double z[SIZE], A[SIZE * SIZE], defect;
  static const double weight[] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12}, at[] = {-2, -1, 1, 2};
  make_magnetic(BOTTLE, &m);
  dvi_integrator *integrator = create_integrator(m.system, "boris");
  memcpy(z, m.q, 3 * sizeof *z);
  ck_assert_int_eq(dvi_system_momentum(m.system, 0, m.q, m.v, z + 3), DVI_OK);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, z, z + 3, 0.5, &defect), DVI_OK);
  ck_assert_double_gt(defect, 1e-4);
  memset(A, 0, sizeof A);
  for (int j = 0; j < SIZE; j++)
    for (int k = 0; k < 4; k++) {
      double moved[SIZE];
      memcpy(moved, z, sizeof z);
      moved[j] += 1e-3 * at[k];
      ck_assert_int_eq(dvi_integrator_start(integrator, 0, moved, moved + 3), DVI_OK);
      ck_assert_int_eq(dvi_integrator_step(integrator, 0.5), DVI_OK);
      for (int i = 0; i < 3; i++) {
        A[i * SIZE + j] += weight[k] / 1e-3 * dvi_integrator_q(integrator)[i];
        A[(i + 3) * SIZE + j] += weight[k] / 1e-3 * dvi_integrator_p(integrator)[i];
      }
    }
  ck_assert_double_eq_tol(determinant(SIZE, A), 1, 1e-9);
  dvi_integrator_destroy(&integrator);
  destroy_magnetic(&m);
}
END_TEST

START_TEST(boris_keeps_the_energy_of_a_charge_in_a_magnetic_field_alone)
{
  static const char *const methods[] = {"boris", "composition:order=4,base=boris"};
  magnetic m;
  double E0, E;
  make_magnetic(BOTTLE, &m);
  dvi_system_destroy(&m.system);
  m.terms.potentials = NULL;
  m.terms.potential_count = 0;
  ck_assert_int_eq(dvi_system_create(&m.terms, &m.system), DVI_OK);
  dvi_integrator *integrator = started(&m, methods[_i]);
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &E0), DVI_OK);
  advance(integrator, 0.3, repeats(2000));
  ck_assert_int_eq(dvi_integrator_invariant(integrator, 0, &E), DVI_OK);
  /* roundings of p - A, which grows with the distance */
  ck_assert_double_eq_tol(E / E0, 1, 1e-11);
  dvi_integrator_destroy(&integrator);
  destroy_magnetic(&m);
}
END_TEST

START_TEST(a_step_back_undoes_a_step_of_boris)
{
  for (int kind = 0; kind < MAGNETIC_KINDS; kind++) {
    magnetic m;
    make_magnetic((magnetic_kind)kind, &m);
    dvi_integrator *integrator = started(&m, "boris");
    advance(integrator, 0.3, 5);
    advance(integrator, -0.3, 5);
    ck_assert_double_lt(
        distance_from(&m, 0, dvi_integrator_q(integrator), dvi_integrator_p(integrator), m.q, m.v),
        1e-14);
    dvi_integrator_destroy(&integrator);
    destroy_magnetic(&m);
  }
}
END_TEST

SUITE(boris)
{
  tcase_add_test(tests, boris_preserves_the_volume_and_is_not_symplectic);
  tcase_add_loop_test(tests, boris_keeps_the_energy_of_a_charge_in_a_magnetic_field_alone, 0, 2);
  tcase_add_test(tests, a_step_back_undoes_a_step_of_boris);
}
