/* Multiscale variational integrators take steps beyond the fast periods, which the basis functions
 * resolve.
 *
 * The space is q(t) = p(t) + r(t) sin(omega t) + s(t) cos(omega t) in fast coordinates and p(t) in
 * slow ones. The polynomial p has degree d, and r and s have degree m. With harmonics=2 the space
 * also has constants times sin(2 omega t) and cos(2 omega t), which a nonlinear motion contains.
 * The quadrature is Filon-Lobatto with d+1 nodes for m=0, else d+2, for twice the harmonics of the
 * space. Where as many points resolve the oscillation by themselves, Gauss's rule is taken
 * (space/oscillating.h).
 *     Ld(q0,q1) = ext over such paths q from q0 to q1 of the quadrature of L,
 *     p0 = -D1 Ld,   p1 = D2 Ld
 *
 * The rows are those of step/element/action.h in another space (step/element/user_element.h). The
 * path of a linear oscillator of frequency omega lies in the space, and its action is exact.
 * Therefore its steps are exact for every h omega. The method is symmetric and symplectic. As h
 * goes to 0 with fixed omega, the space is as good as polynomials of degree d+2m+2, as long as
 * these differ by more than roundoff, and the order is twice that degree. With a slow coordinate,
 * which has polynomials of degree d, the order is 2d. Source: Leok 2004, sec. 5.7. The path there
 * is a product, p(t) (1 + r sin + s cos), which is singular where the amplitude is 0. The sum is
 * ours, and so is the quadrature of any Lagrangian by samples of the phase. */
#include <math.h>

#include "step/split/fastest.h"
#include "step/split/modes.h"
#include "step/element/user_element.h"
#include "core/memory.h"
#include "method/one_step.h"
#include "num/compensated.h"
#include "space/oscillating.h"
#include "system/part.h"

enum { DEGREE, AMPLITUDE, HARMONICS, OMEGA };

static const dvi__key keys[] = {
    {"degree", NULL, 1, DVI__OSCILLATING_DEGREE_MOST, 3,
     "degree of the path without its oscillation, 1 to 6; default: 3"},
    {"amplitude", NULL, 0, DVI__OSCILLATING_DEGREE_MOST, DVI__LEFT_OUT,
     "degree of the oscillation's amplitudes, 0 to degree; default: 1"},
    {"harmonics", NULL, 1, 2, 1,
     "harmonics of the oscillation, 1 or 2; the second one has constant amplitudes; default: 1"},
    {"omega", NULL, DVI__POSITIVE, 0, 0,
     "the fast frequency; left out, or auto: that of quadratic fast potentials, else found at the "
     "first step"},
    {0},
};

typedef struct multiscale_options {
  int degree, amplitude, harmonics;
  double omega; /* 0 if it is to be found */
} multiscale_options;

static multiscale_options multiscale_options_of(const dvi__stepper *self)
{
  const int *value = self->settings.value;
  return (multiscale_options){.degree = value[DEGREE],
                              .amplitude = value[AMPLITUDE],
                              .harmonics = value[HARMONICS],
                              .omega = self->settings.number[OMEGA]};
}

/* The memory holds the omega of the first step where the user gives none. */
enum { FOUND = DVI__CARRIED };

typedef struct multiscale {
  dvi__one_step one;
  dvi__oscillating *space;
  dvi__fastest *fastest; /* NULL if omega is known */
  double omega;          /* frequency of the space (default 0, not yet known) */
  int fast;              /* number of fast coordinates */
} multiscale;

/* ---- which coordinates are fast, and how fast ---- */

static dvi_status multiscale_mark_listed(const dvi__stepper *self, char *fast)
{
  const int n = self->system->n;
  for (int k = 0; k < self->settings.listed; k++) {
    const double number = self->settings.list[k];
    if (number != floor(number) || number >= n)
      return dvi__fail(
          DVI_BAD_OPTION,
          "multiscale: fast=%s: there is no coordinate %g; they are counted from 0 to %d",
          self->settings.list_text, number, n - 1);
    if (fast[(int)number])
      return dvi__fail(DVI_BAD_OPTION, "multiscale: fast=%s: coordinate %g is listed twice",
                       self->settings.list_text, number);
    fast[(int)number] = 1;
  }
  return DVI_OK;
}

static dvi_status mark_moved(const dvi_system *part, char *fast)
{
  DVI_TRY(dvi__system_prepare_hessian(part));
  for (int i = 0; i < part->n; i++) fast[i] = part->qq.start[i] < part->qq.start[i + 1];
  return DVI_OK;
}

/* Find the one frequency that the space has. Modes that do not oscillate are not counted. */
static dvi_status frequency_of(const dvi__stepper *self, const dvi_system *part, double *omega)
{
  dvi__modes *modes;
  double least;
  DVI_TRY(dvi__modes_create(part, DVI__MODES_BLOCK_MOST, self->counters, &modes));
  dvi__modes_range(modes, &least, omega);
  dvi__modes_destroy(&modes);
  if (*omega > 0 && least > (1 - 5e-7) * *omega) return DVI_OK;
  if (*omega == 0)
    return dvi__fail(DVI_BAD_OPTION,
                     "multiscale: nothing oscillates in the fast potentials; give omega");
  return dvi__fail(DVI_BAD_OPTION,
                   "multiscale: the fast potentials have frequencies from %.6g to %.6g; give the "
                   "one that matters as omega",
                   least, *omega);
}

/* Find the defaults from the part of the system that is declared fast. If this part does not give a
 * frequency, the first step finds one. */
static dvi_status ask_fast_part(dvi__stepper *self, char *fast)
{
  const dvi_system *system = self->system;
  const int listed = self->settings.listed > 0;
  double *omega = &self->settings.number[OMEGA];
  dvi_system *part;
  self->bound = 1;
  if (!(system->terms & DVI__FAST) && !listed)
    return dvi__fail(DVI_BAD_OPTION, "multiscale: no coordinate is known to be fast: list them, as "
                                     "fast=0:1, or declare a fast potential");
  if (!(system->terms & DVI__CONSTANT_MASS) && !listed)
    return dvi__fail(DVI_BAD_OPTION, "multiscale: the fast coordinates must be listed where the "
                                     "mass is not constant, as fast=0:1");
  const int told = system->terms & DVI__FAST && system->terms & DVI__CONSTANT_MASS &&
                   dvi__system_fast_is_quadratic(system);
  if (listed && !told) return DVI_OK;
  DVI_TRY(dvi__system_fast_part(system, &part));
  dvi_status status = listed ? DVI_OK : mark_moved(part, fast);
  if (status == DVI_OK && told && *omega == 0) status = frequency_of(self, part, omega);
  dvi_system_destroy(&part);
  return status;
}

static dvi_status find_fast(dvi__stepper *self, char *fast)
{
  DVI_TRY(multiscale_mark_listed(self, fast));
  return self->settings.listed == 0 || multiscale_options_of(self).omega == 0
             ? ask_fast_part(self, fast)
             : DVI_OK;
}

/* ---- create ---- */

static void explain_omega(const dvi__stepper *self, dvi__text *text)
{
  const multiscale *own = self->own;
  const double omega = own->fastest == NULL   ? own->omega
                       : self->memory == NULL ? 0
                                              : self->memory[FOUND];
  if (omega == 0)
    dvi__text_add(text, "omega: found at the first step, as the highest frequency of small "
                        "oscillations about the start\n");
  else
    dvi__text_add(text, "omega: %.6g%s\n", omega,
                  own->fastest == NULL ? "" : ", found at the first step");
}

static void multiscale_explain(const dvi__stepper *self, dvi__text *text)
{
  const multiscale *own = self->own;
  const multiscale_options o = multiscale_options_of(self);
  dvi__text_add(text,
                "space: polynomials of degree %d, and in %d fast coordinate%s of degree %d times "
                "sin and cos of omega t%s\n",
                o.degree, own->fast, own->fast == 1 ? "" : "s", o.amplitude,
                o.harmonics == 2 ? ", and these of 2 omega t" : "");
  explain_omega(self, text);
  dvi__text_add(
      text,
      "quadrature: %d points; up to h omega = %.3g Gauss's, for longer steps Filon-Lobatto's\n",
      dvi__oscillating_shapes(own->space).points, dvi__oscillating_resolved(own->space));
}

static dvi_status duration_of(void *of, const double *x, double *duration)
{
  return dvi__user_element_duration(of, x, duration);
}

static dvi_status multiscale_place(dvi__stepper *self, const dvi__state *state, double h,
                                   double part)
{
  const dvi__one_step *one = self->own;
  (void)part;
  dvi__user_element_place(one->of, state->t, h, state->q, state->p);
  return DVI_OK;
}

DVI__STEP_KIND(user_element, multiscale_place, multiscale_explain, .duration = duration_of,
               .renewed = 1);

static dvi_status prepare_to_find(dvi__stepper *self, const char *fast)
{
  multiscale *own = self->own;
  if (own->fast <= DVI__FASTEST_MOST)
    return dvi__fastest_create(self->system, fast, self->counters, &own->fastest);
  return dvi__fail(DVI_BAD_OPTION,
                   "multiscale: of %d fast coordinates the frequency is not found, of up to %d it "
                   "is: give omega",
                   own->fast, DVI__FASTEST_MOST);
}

/* Make the space, which the stepper owns from then on. The space waits for an omega that is not
 * known. */
static dvi_status multiscale_initialise(dvi__stepper *self, const char *fast)
{
  const multiscale_options o = multiscale_options_of(self);
  dvi__user_element *element = NULL;
  dvi__oscillating *space = dvi__oscillating_create(o.degree, o.amplitude, o.harmonics, o.omega);
  if (space == NULL) return dvi__fail(DVI_NO_MEMORY, "multiscale: no memory");
  const dvi__shapes shapes = dvi__oscillating_shapes(space);
  dvi_status status = dvi__user_element_create(self->system, &shapes, fast, o.degree,
                                               self->counters, &element);
  if (status == DVI_OK)
    status = dvi__one_step_create(self, sizeof(multiscale), &kind, element, o.omega == 0);
  multiscale *own = self->own;
  if (own == NULL) {
    dvi__oscillating_destroy(&space);
    return status;
  }
  own->space = space;
  own->omega = o.omega;
  for (int i = 0; i < self->system->n; i++) own->fast += fast[i];
  self->order = 2 * (own->fast < self->system->n ? o.degree : shapes.functions);
  self->symmetric = 1;
  return status == DVI_OK && o.omega == 0 ? prepare_to_find(self, fast) : status;
}

static dvi_status multiscale_create(dvi__stepper *self)
{
  int *amplitude = &self->settings.value[AMPLITUDE];
  if (*amplitude == DVI__LEFT_OUT) *amplitude = 1;
  const int degree = multiscale_options_of(self).degree;
  if (*amplitude > degree)
    return dvi__fail(DVI_BAD_OPTION,
                     "multiscale: amplitude=%d is above degree=%d; 0 to degree are possible",
                     *amplitude, degree);
  char *fast = DVI_NEW(char, self->system->n);
  if (fast == NULL) return dvi__fail(DVI_NO_MEMORY, "multiscale: no memory");
  dvi_status status = find_fast(self, fast);
  if (status == DVI_OK) status = multiscale_initialise(self, fast);
  dvi__release(fast);
  return status;
}

static void multiscale_destroy(dvi__stepper *self)
{
  multiscale *own = self->own;
  if (own == NULL) return;
  dvi__oscillating *space = own->space;
  dvi__fastest_destroy(&own->fastest);
  dvi__one_step_destroy(self);
  dvi__oscillating_destroy(&space);
}

/* ---- the step ---- */

/* Make the tables for the omega of this run. Another run, or a restored one, may have used this
 * stepper in between. */
static void multiscale_tune_tables(const dvi__stepper *self)
{
  multiscale *own = self->own;
  if (own->fastest == NULL || own->omega == self->memory[FOUND]) return;
  own->omega = self->memory[FOUND];
  dvi__oscillating_tune(own->space, own->omega);
  dvi__user_element_renew(own->one.of);
}

static dvi_status find_omega(const dvi__stepper *self, const dvi__state *state)
{
  const multiscale *own = self->own;
  if (own->fastest == NULL || self->memory[FOUND] != 0) return DVI_OK;
  return dvi__fastest_frequency(own->fastest, state->t, state->q, self->memory + own->one.last,
                                &self->memory[FOUND]);
}

static dvi_status multiscale_step(dvi__stepper *self, dvi__state *state, double h)
{
  const dvi__one_step *one = self->own;
  DVI_TRY(find_omega(self, state));
  multiscale_tune_tables(self);
  DVI_TRY(dvi__one_step_solve(self, state, h));
  dvi__user_element_ends(one->of, one->x, one->dq, one->dp);
  DVI_TRY(dvi__one_step_move(self, state, h, one->x));
  dvi__add_compensated_all(self->system->n, state->p, state->p_compensation, one->dp);
  return DVI_OK;
}

static void multiscale_path(const dvi__stepper *self, const double *q0, double h, double tau,
                            double *q, double *v)
{
  const dvi__one_step *one = self->own;
  multiscale_tune_tables(self);
  dvi__user_element_path(one->of, self->memory + one->last, h, tau, q, v);
  for (int i = 0; q != NULL && i < self->system->n; i++) q[i] += q0[i];
}

const dvi__method dvi__multiscale = {
    .name = "multiscale",
    .summary = "polynomials and oscillations of a given frequency, Filon-Lobatto quadrature; steps "
               "beyond fast periods; symplectic",
    .cite = "Leok2004",
    .keys = keys,
    .list = "fast",
    .list_help = "the fast coordinates, by their numbers from 0, such as 0:2; default: those of "
                 "the fast potentials",
    .uses = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL,
    .create = multiscale_create,
    .destroy = multiscale_destroy,
    .start = dvi__one_step_start,
    .step = multiscale_step,
    .path = multiscale_path,
    .explain = dvi__one_step_explain,
};
