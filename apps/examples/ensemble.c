/* A thousand pendulums in one ensemble, from small swings to almost the top. They show how the
 * period grows with the amplitude. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

enum { MEMBERS = 1000, LOOKS = 250 };

static const double pi = 3.14159265358979323846, h = 0.01;

/* The callbacks have the batch shape. One loop serves all members that are worked on together. */
static int members_potential(int count, const double *t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V[k] = -cos(q[k]);
  return 0;
}

static int members_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  for (int k = 0; k < count; k++) V_q[k] = sin(q[k]);
  return 0;
}

/* 2 pi over the arithmetic-geometric mean of 1 and cos(a/2) (Gauss). */
static double pendulum_period(double amplitude)
{
  double a = 1, g = cos(amplitude / 2);
  for (int i = 0; i < 8; i++) {
    const double mean = (a + g) / 2;
    g = sqrt(a * g);
    a = mean;
  }
  return 2 * pi / a;
}

static double member_amplitude(int k)
{
  return 3.0 * (k + 1) / (double)MEMBERS;
}

/* Note the periods. A quarter of the period is over when q changes sign, and the velocity gives the
 * time between two steps. */
static void members_note_period(const double *t, const double *q, const double *p, double *period)
{
  for (int k = 0; k < MEMBERS; k++)
    if (period[k] == 0 && q[k] <= 0) period[k] = 4 * (t[k] - q[k] / p[k]);
}

static dvi_status members_swing(dvi_ensemble *ensemble, double *period)
{
  static double t[MEMBERS], q[MEMBERS], p[MEMBERS];
  for (int k = 0; k < MEMBERS; k++) q[k] = member_amplitude(k);
  dvi_status status = dvi_ensemble_start(ensemble, 0, q, p);
  /* No member is at the bottom before t = pi/2, so these steps are one call. */
  if (status == DVI_OK) status = dvi_ensemble_advance(ensemble, h, (long)(pi / 2 / h));
  for (int i = 0; i < LOOKS && status == DVI_OK; i++) {
    status = dvi_ensemble_step(ensemble, h);
    if (status == DVI_OK) status = dvi_ensemble_state(ensemble, t, q, p);
    if (status == DVI_OK) members_note_period(t, q, p, period);
  }
  return status;
}

int main(void)
{
  static double period[MEMBERS];
  const dvi_potential gravity = {
      .name = "gravity", .value_batch = members_potential, .gradient_batch = members_gradient};
  const dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .potentials = &gravity, .potential_count = 1};
  const dvi_ensemble_options options = {.members = MEMBERS, .threads = 2};
  dvi_system *system = NULL;
  dvi_ensemble *ensemble = NULL;
  double worst = 0;
  dvi_status status = dvi_system_create(&terms, &system);
  if (status == DVI_OK)
    status = dvi_ensemble_create(system, "galerkin:degree=3", &options, &ensemble);
  if (status == DVI_OK) status = members_swing(ensemble, period);
  if (status != DVI_OK) fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
  for (int k = 0; k < MEMBERS; k++) {
    const double error = fabs(period[k] - pendulum_period(member_amplitude(k)));
    worst = fmax(worst, error);
    if ((k + 1) % 250 == 0)
      printf("amplitude %.2f: period %.8f, error %.1e\n", member_amplitude(k), period[k], error);
  }
  dvi_ensemble_destroy(&ensemble);
  dvi_system_destroy(&system);
  /* Going back from a time s after the bottom by q/p, which is tan(s) there, has an error of s^3/3,
   * and of four times that for a period. */
  return status == DVI_OK && worst < 4 * 1.01 * h * h * h / 3 ? 0 : 1;
}
