#include "support/field/schroedinger.h"

#include <math.h>
#include <stdlib.h>

#include "support/field/function_spaces.h"
#include "support/field/marches.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

quantum quantum_with(dvi_space *space, const dvi_schroedinger_terms *terms)
{
  dvi_schroedinger_terms whole = *terms;
  quantum q = {.space = space, .functions = dvi_space_functions(space)};
  whole.size = sizeof whole;
  whole.space = space;
  ck_assert_msg(dvi_schroedinger_create(&whole, &q.equation) == DVI_OK, "%s", dvi_last_error());
  return q;
}

quantum quantum_on_line(const char *kind, double from, double to, int periodic,
                        potential_of_points *V, double interaction)
{
  const dvi_schroedinger_terms terms = {.potential = V, .interaction = interaction};
  return quantum_with(space_on_line(kind, from, to, periodic), &terms);
}

quantum quantum_on_square(const char *kind, double from, double to, int periodic,
                          potential_of_points *V, double interaction)
{
  const dvi_axis axis = {.from = from, .to = to, .periodic = periodic}, axes[] = {axis, axis};
  const dvi_space_options options = {.size = sizeof options, .kind = kind, .axis = axes, .axes = 2};
  const dvi_schroedinger_terms terms = {.potential = V, .interaction = interaction};
  dvi_space *space = NULL;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  return quantum_with(space, &terms);
}

void free_quantum(quantum *q)
{
  dvi_schroedinger_destroy(&q->equation);
  dvi_space_destroy(&q->space);
}

int harmonic(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = 0.5 * x[i] * x[i];
  return 0;
}

int harmonic_square(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = 0.5 * (x[i] * x[i] + x[count + i] * x[count + i]);
  return 0;
}

dvi_march *quantum_march(const quantum *q, const char *method, double step)
{
  const dvi_schroedinger_march_options options = {
      .size = sizeof options, .method = method, .step = step};
  dvi_march *march = NULL;
  ck_assert_msg(dvi_schroedinger_march(q->equation, &options, &march) == DVI_OK, "%s",
                dvi_last_error());
  return march;
}

/* ---- functions ---- */

double complex turned_by(double angle)
{
  const union {
    double part[2];
    double complex whole;
  } number = {{cos(angle), sin(angle)}};
  return number.whole;
}

typedef struct part {
  wave_of_x *f;
  const double *parameter;
  int imaginary;
} part;

static int part_of_wave(int64_t count, const double *x, double *f, void *user)
{
  const part *p = user;
  for (int64_t i = 0; i < count; i++) {
    const double complex value = p->f(x[i], p->parameter);
    f[i] = p->imaginary ? cimag(value) : creal(value);
  }
  return 0;
}

double *wave_on(const quantum *q, wave_of_x *f, const double *parameter)
{
  double *psi = calloc(2 * (size_t)q->functions, sizeof *psi);
  for (int c = 0; c < 2; c++) {
    part p = {f, parameter, c};
    ck_assert(dvi_space_interpolate(q->space, part_of_wave, &p, psi + c * q->functions) == DVI_OK);
  }
  return psi;
}

void start_wave(dvi_march *march, const quantum *q, wave_of_x *f, const double *parameter)
{
  double *psi = wave_on(q, f, parameter);
  const dvi_march_state state = {.size = sizeof state, .A = psi};
  ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
  free(psi);
}

double distance_from(const dvi_march *march, const quantum *q, wave_of_x *f,
                     const double *parameter)
{
  const int none[DVI_AXES_MAX] = {0};
  const double *x, *weight;
  const int64_t points = dvi_space_points(q->space, &x, &weight);
  double *psi = sample_march(march, DVI_FORM_A), *u = calloc(2 * (size_t)points, sizeof *u),
         sum = 0;
  for (int c = 0; c < 2; c++)
    ck_assert(dvi_space_apply(q->space, none, psi + c * q->functions, u + c * points) == DVI_OK);
  for (int64_t k = 0; k < points; k++) {
    const double complex value = f(x[k], parameter);
    sum += weight[k] * (pow(u[k] - creal(value), 2) + pow(u[points + k] - cimag(value), 2));
  }
  free(psi);
  free(u);
  return sqrt(sum);
}

double complex packet(double x, const double *parameter)
{
  const double y = x - parameter[0], size = pow(pi, -0.25) * exp(-0.5 * y * y);
  return size * turned_by(parameter[1] * x);
}

/* Place q and momentum p move as those of the classical oscillator, and the phase is that of the
 * ground state and of (q p - q0 p0)/2 (Schroedinger 1926). */
double complex moved_packet(double x, const double *parameter)
{
  const double t = parameter[2], q = parameter[0] * cos(t) + parameter[1] * sin(t),
               p = parameter[1] * cos(t) - parameter[0] * sin(t),
               phase = -0.5 * t - 0.5 * (q * p - parameter[0] * parameter[1]);
  const double now[] = {q, p};
  return packet(x, now) * turned_by(phase);
}
