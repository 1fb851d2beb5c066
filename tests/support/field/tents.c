#include "support/field/tents.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "support/field/generated.h"
#include "support/meshes.h"

static const double pi = 3.14159265358979323846;

pitched tents_over(dvi_mesh *mesh, int k, const double *const *factor, const int8_t *held,
                   dvi__tents_options options)
{
  pitched p = {.k = k, .size = dvi_mesh_count(mesh, k), .above = dvi_mesh_count(mesh, k + 1)};
  const dvi_star_options star = {.size = sizeof star, .factor = factor};
  ck_assert_msg(dvi_star_create(mesh, &star, &p.star) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  ck_assert_msg(dvi__tents_create(&(dvi__tents_terms){.star = p.star, .k = k, .held = held},
                                  &options, &p.tents) == DVI_OK,
                "%s", dvi_last_error());
  p.A = calloc((size_t)p.size, sizeof *p.A);
  p.E = calloc((size_t)p.size, sizeof *p.E);
  p.B = calloc((size_t)p.above, sizeof *p.B);
  return p;
}

void strike_tents(pitched *p)
{
  dvi__tents_destroy(&p->tents);
  dvi_star_destroy(&p->star);
  free(p->A);
  free(p->E);
  free(p->B);
}

void start_tents(const pitched *p)
{
  dvi__tents_start(p->tents, &(dvi_march_state){.A = p->A, .E = p->E});
}

void advance_tents(const pitched *p, double t)
{
  ck_assert_msg(dvi__tents_advance(p->tents, t) == DVI_OK, "%s", dvi_last_error());
}

void sample_tents(const pitched *p)
{
  ck_assert_int_eq(dvi__tents_sample(p->tents, DVI_FORM_A, p->size, NULL, p->A), DVI_OK);
  ck_assert_int_eq(dvi__tents_sample(p->tents, DVI_FORM_E, p->size, NULL, p->E), DVI_OK);
  ck_assert_int_eq(dvi__tents_sample(p->tents, DVI_FORM_B, p->above, NULL, p->B), DVI_OK);
}

double energy_of_tents(const pitched *p)
{
  double energy;
  ck_assert_msg(dvi__tents_energy(p->tents, &energy) == DVI_OK, "%s", dvi_last_error());
  return energy;
}

static int wave_at(const double *x, double *value, void *user)
{
  const plane_wave *w = user;
  const double angle = 2 * pi * x[0], f = w->is_sine ? sin(angle) : cos(angle);
  for (int c = 0; c < w->components; c++) value[c] = w->factor[c] * f;
  return 0;
}

void integrate_wave(const pitched *p, int k, plane_wave w, double *form)
{
  const dvi_mesh *mesh = dvi_star_mesh(p->star);
  w.components = dvi_form_components(dvi_mesh_space(mesh), k);
  ck_assert_int_eq(dvi_form_integrate(mesh, k, wave_at, &w, form), DVI_OK);
}

void set_sine(const pitched *p, double c)
{
  integrate_wave(p, 0, (plane_wave){.factor = {1}, .is_sine = 1}, p->A);
  integrate_wave(p, 0, (plane_wave){.factor = {2 * pi * c}}, p->E);
}

double largest_error(int64_t count, const double *a, const double *b)
{
  double most = 0;
  for (int64_t i = 0; i < count; i++) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

void fill_at_random(int64_t count, double size, unsigned long long seed, double *form)
{
  for (int64_t i = 0; i < count; i++) form[i] = size * (2 * random_number(&seed) - 1);
}

const tent_place tent_places[TENT_PLACES] = {
    {NULL, 1, 24, 0},  {NULL, 2, 6, 6},        {"interval", 1, 9, 0}, {"staggered", 2, 5, 4},
    {"disk", 2, 3, 0}, {"icosphere", 2, 1, 0}, {"bcc-torus", 3, 3, 3}};

dvi_mesh *mesh_at(const tent_place *at)
{
  if (at->generator == NULL)
    return at->n == 1 ? ring_mesh(at->across, 0.3, 5) : equilateral_torus(at->across, at->up);
  dvi_generator_options options = {.cells = {at->across, at->up}};
  if (at->n == 3) options.cells[2] = at->up;
  return generated(at->generator, options);
}
