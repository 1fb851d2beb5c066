/* labels: judge */
/* Steps of verlet on random solids, and energies there, beside quadruple precision. */
#include <math.h>
#include <stdlib.h>

#include "support/meshes.h"
#include "support/runs.h"
#include "support/solid/judged_solids.h"
#include "support/suite.h"

enum { CASES = 48, STEPS = 100 };

/* Everything at random but what a number of bits says. */
static solid_case random_case(int i)
{
  unsigned long long seed = (unsigned)i + 1;
  const double grading = 1 + random_number(&seed), jitter = 0.25 * random_number(&seed);
  static const unsigned traits[] = {SOLID_OF_TWO, SOLID_OF_TWO | SOLID_LOADED,
                                    SOLID_OF_TWO | SOLID_LOADED | SOLID_MOVED};
  return (solid_case){.n = 2 + i % 2,
                      .cells = 1 + (int)(random_number(&seed) * (i % 2 ? 1.5 : 3)),
                      .grading = grading,
                      .jitter = jitter,
                      .law = (dvi_elastic_law)(i / 2 % 4),
                      .traits = traits[i / 8 % 3],
                      .split = i / 24,
                      .seed = (unsigned)i + 1};
}

typedef struct walk {
  judged_solid s;
  const char *name;
  dvi_system *system;
  dvi_integrator *integrator;
  quad *u, *v, *a;
  double *lifted, *rate;
  double h, t;
} walk;

static void start_walk(walk *w)
{
  const int size = w->s.judge.size;
  double *u = rounded(size, w->u), *rate = rounded(size, w->v), omega,
         *q = calloc((size_t)size, sizeof *q), *p = calloc((size_t)size, sizeof *p);
  dvi_elastic_project(w->s.elastic, u, rate, q, NULL, p);
  ck_assert_int_eq(dvi_elastic_system(w->s.elastic, &w->system), DVI_OK);
  w->integrator = create_integrator(w->system, "verlet");
  ck_assert_msg(dvi_integrator_start(w->integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_elastic_fastest(w->s.elastic, &omega), DVI_OK);
  w->h = ldexp(1, (int)floor(log2(1 / omega)));
  quad_solid_accelerate(&w->s.judge, 0, w->u, w->v, w->a);
  free(u), free(rate), free(q), free(p);
}

static walk walk_of(int i)
{
  const solid_case of = random_case(i);
  walk w = {.s = make_judged(&of, NULL, 0), .name = name_solid(&of)};
  const size_t size = (size_t)w.s.judge.size;
  w.u = calloc(size, sizeof *w.u), w.v = calloc(size, sizeof *w.v);
  w.a = calloc(size, sizeof *w.a);
  w.lifted = calloc(size, sizeof *w.lifted), w.rate = calloc(size, sizeof *w.rate);
  start_judged(&w.s, 0.5, w.u, w.v);
  for (size_t k = 0; k < size; k++) w.u[k] = (double)w.u[k], w.v[k] = (double)w.v[k];
  start_walk(&w);
  return w;
}

static void end_walk(walk *w)
{
  dvi_integrator_destroy(&w->integrator);
  dvi_system_destroy(&w->system);
  free(w->u), free(w->v), free(w->a), free(w->lifted), free(w->rate);
  end_judged_solid(&w->s);
}

static void half_kick(walk *w)
{
  for (int i = 0; i < w->s.judge.size; i++) w->v[i] += w->a[i] * w->h / 2;
}

static void step_of_judge(walk *w)
{
  half_kick(w);
  for (int i = 0; i < w->s.judge.size; i++) w->u[i] += w->v[i] * w->h;
  w->t += w->h;
  quad_solid_give(&w->s.judge, w->t, w->u, w->v);
  quad_solid_accelerate(&w->s.judge, w->t, w->u, w->v, w->a);
  half_kick(w);
}

/* Lift coordinates and momenta, and compare them. */
static void compare(walk *w)
{
  const int size = w->s.judge.size;
  ck_assert_int_eq(dvi_elastic_lift(w->s.elastic, w->t, dvi_integrator_q(w->integrator),
                                    dvi_integrator_p(w->integrator), w->lifted, w->rate),
                   DVI_OK);
  const double in_u = error_of_solid(size, w->lifted, w->u),
               in_v = error_of_solid(size, w->rate, w->v);
  ck_assert_msg(in_u < 1e-13 && in_v < 1e-12, "%s: u off by %g, u' by %g at t = %g", w->name, in_u,
                in_v, w->t);
}

static void check_energies(const walk *w)
{
  const quad_solid *s = &w->s.judge;
  const int n = s->n;
  dvi_elastic_energies energies;
  quad stored = 0, kinetic = 0;
  ck_assert_int_eq(dvi_elastic_energy(w->s.elastic, w->t, w->lifted, w->rate, NULL, &energies),
                   DVI_OK);
  for (int cell = 0; cell < s->cells; cell++) {
    quad u[12] = {0}, f[12];
    for (int k = 0; k < (n + 1) * n; k++)
      u[k] = w->u[s->vertex[cell * (n + 1) + k / n] * n + k % n];
    stored += quad_solid_cell(s, cell, 0, u, f);
  }
  for (int i = 0; i < s->size; i++) kinetic += s->mass[i / n] * w->v[i] * w->v[i] / 2;
  ck_assert_double_eq_tol(energies.stored, (double)stored, 1e-13);
  ck_assert_double_eq_tol(energies.kinetic, (double)kinetic, 1e-13);
}

/* Later some solids are nearly inverted, and pull with forces that amplify roundings. */
START_TEST(steps_of_verlet_are_those_of_the_judge)
{
  for (int c = 0; c < sampled_count(CASES); c++) {
    walk w = walk_of(sampled_case(c));
    for (int step = 0; step < STEPS && w.t < 4; step++) {
      step_of_judge(&w);
      advance(w.integrator, w.h, 1);
      compare(&w);
    }
    check_energies(&w);
    end_walk(&w);
  }
}
END_TEST

SUITE(solid_steps)
{
  tcase_add_test(tests, steps_of_verlet_are_those_of_the_judge);
}
