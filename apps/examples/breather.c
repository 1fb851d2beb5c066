/* A breather of the sine-Gordon equation, by multisymplectic steps: its error after some turns, its
 * energy, and the laws that the steps fulfil. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

enum { CELLS = 401, STEPS = 400 };

/* l = u_t^2/2 - u_x^2/2 - (1 - cos u), with z = (u, u_t, u_x). Of its second derivatives those on
 * the diagonal are not zero. */
static const dvi_jet variable[] = {{.component = 0}, {.rate = 1}, {.order = {1, 0, 0}}};
static const int diagonal[][2] = {{0, 0}, {1, 1}, {2, 2}};

static int sine_gordon(int count, double t, const double *x, const double *z, double *l,
                       double *l_z, double *l_zz, void *user)
{
  const double *u = z, *v = z + count, *w = z + 2 * count;
  (void)t, (void)x, (void)user;
  for (int i = 0; i < count; i++) {
    if (l) l[i] = v[i] * v[i] / 2 - w[i] * w[i] / 2 - (1 - cos(u[i]));
    if (l_z) l_z[i] = -sin(u[i]), l_z[count + i] = v[i], l_z[2 * count + i] = -w[i];
    if (l_zz) l_zz[i] = -cos(u[i]), l_zz[count + i] = 1, l_zz[2 * count + i] = -1;
  }
  return 0;
}

static double breather(double t, double x)
{
  return 4 * atan(sqrt(3) * sin(t / 2) / cosh(sqrt(3) / 2 * x));
}

static dvi_status follow(dvi_march *march, const double *x, double step)
{
  const double t = (double)STEPS * step;
  double u[CELLS], energy, later, error = 0;
  dvi_status status = dvi_march_observe(march, 0, &energy);
  if (!status) status = dvi_march_advance(march, t);
  if (!status) status = dvi_march_sample(march, DVI_FORM_A, 0, NULL, u);
  if (!status) status = dvi_march_observe(march, 0, &later);
  if (status) return status;
  for (int i = 0; i < CELLS; i++) error = fmax(error, fabs(u[i] - breather(t, x[i])));
  printf("t = %g, largest error %.2e\n", t, error);
  printf("energy %.6f, later %.6f\n", energy, later);
  return DVI_OK;
}

int main(void)
{
  const dvi_axis axis = {.from = -20, .to = 20, .periodic = 1};
  const dvi_density_part density = {.kind = DVI_DENSITY_GENERAL,
                                    .variable = variable,
                                    .variables = 3,
                                    .pair = diagonal,
                                    .pairs = 3,
                                    .density = sine_gordon};
  dvi_multisymplectic_terms terms = {.size = sizeof terms,
                                     .axis = &axis,
                                     .axes = 1,
                                     .cells = {CELLS},
                                     .components = 1,
                                     .part = &density,
                                     .parts = 1,
                                     .step = 0.05};
  double x[CELLS], E[CELLS];
  dvi_march *march = NULL;
  dvi_law law[DVI_LAWS_MAX];
  int laws = 0;
  dvi_multisymplectic_vertices(&terms, x);
  /* at t = 0 the breather is flat, and moves */
  for (int i = 0; i < CELLS; i++) E[i] = -2 * sqrt(3) / cosh(sqrt(3) / 2 * x[i]);
  const dvi_march_state start = {.size = sizeof start, .E = E};
  dvi_status status = dvi_multisymplectic_parse("multisymplectic:space=0,time=0", &terms.weights);
  if (!status) status = dvi_multisymplectic_create(&terms, &march);
  if (!status) status = dvi_march_start(march, &start);
  if (!status) status = follow(march, x, terms.step);
  if (!status) status = dvi_multisymplectic_laws(&terms, &start, 20, 1, law, &laws);
  for (int i = 0; i < laws && !status; i++) printf("%s %.1e\n", law[i].name, law[i].error);
  if (status) fprintf(stderr, "%s\n", dvi_last_error());
  dvi_march_destroy(&march);
  return status != 0;
}
