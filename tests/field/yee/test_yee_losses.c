/* labels: unit */
/* Random conductors on boxes, up to those in which E vanishes at once: leapfrog on the mesh of the
 * same boxes is the judge. */
#include <dvi/yee.h>
#include <math.h>
#include <stdlib.h>

#include "support/field/electric.h"
#include "support/waves/boxes.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { GRIDS = 4, STEPS = 40 };
static const int cells[] = {5, 4, 3};
static const double step = 0.08;

/* Both marches, and where E of the mesh is on the grid, with its sign. */
typedef struct pair {
  dvi_march *yee, *leapfrog;
  dvi_field *field;
  int64_t count, *place;
  double *sign;
} pair;

/* Give the number of a place among boxes. */
static int box_with(const double *x, int axes)
{
  int number = 0;
  for (int l = axes - 1; l >= 0; l--) number = number * cells[l] + (int)(x[l] * cells[l]);
  return number;
}

/* Half of the boxes conduct, with conductivities of all orders up to `most`. */
static double *random_sigma(int boxes, double most)
{
  unsigned long long seed = 5;
  double *sigma = calloc((size_t)boxes, sizeof *sigma);
  for (int i = 0; i < boxes; i++)
    if (random_number(&seed) < 0.5) sigma[i] = most * pow(10, -10 * random_number(&seed));
  return sigma;
}

/* Cells of E are nodes, or edges from their first vertex to the second one. */
static void match_cells(pair *p, const dvi_mesh *mesh, const dvi_yee_terms *terms)
{
  const double *x = dvi_mesh_points(mesh);
  const int *vertex = dvi_mesh_vertices(mesh, 1, NULL), axes = terms->axes;
  p->place = calloc((size_t)p->count, sizeof *p->place);
  p->sign = calloc((size_t)p->count, sizeof *p->sign);
  for (int64_t i = 0; i < p->count; i++) {
    const double *from = x + axes * (terms->degree > 0 ? vertex[2 * i] : i),
                 *to = terms->degree > 0 ? x + axes * vertex[2 * i + 1] : from;
    int at[3] = {0, 0, 0}, c = axes == 1 ? 1 : 2;
    p->sign[i] = 1;
    for (int l = 0; l < axes; l++) {
      at[l] = (int)lround(fmin(from[l], to[l]) * cells[l]);
      if (from[l] == to[l]) continue;
      c = l;
      p->sign[i] = from[l] < to[l] ? 1 : -1;
    }
    p->place[i] = dvi_yee_place(terms, DVI_FORM_E, c, at);
  }
}

static void start_pair(pair *p)
{
  double *E = random_values(p->count, 3), *on_grid = calloc((size_t)p->count, sizeof *E);
  const dvi_march_state state = {.size = sizeof state, .E = E};
  for (int64_t i = 0; i < p->count; i++) on_grid[p->place[i]] = p->sign[i] * E[i];
  ck_assert_int_eq(dvi_march_start(p->leapfrog, &state), DVI_OK);
  start_boxes(p->yee, on_grid, NULL);
  free(E), free(on_grid);
}

/* Grids of one to three axes, between electric or magnetic walls. */
static pair make_pair(int number, double most)
{
  const int axes = number == 0 ? 1 : number < 3 ? 2 : 3, has_pec = number % 2;
  const dvi_wall wall = {.part = "boundary", .kind = DVI_PEC};
  dvi_generator_options options = {.dimension = axes};
  dvi_yee_terms terms = {.size = sizeof terms, .axes = axes, .degree = number > 1, .step = step};
  int boxes = 1;
  for (int l = 0; l < axes; l++) {
    options.cells[l] = terms.axis[l].cells = cells[l];
    for (int e = 0; e < 2; e++) terms.axis[l].end[e].kind = has_pec ? DVI_YEE_PEC : DVI_YEE_PMC;
    boxes *= cells[l];
  }
  dvi_mesh *mesh = generated("box", options);
  double *sigma = random_sigma(boxes, most), *by_cell = calloc((size_t)boxes, sizeof *by_cell),
         *centre = calloc((size_t)(boxes * axes), sizeof *centre);
  ck_assert_int_eq(dvi_mesh_centres(mesh, axes, centre), DVI_OK);
  for (int i = 0; i < boxes; i++) by_cell[i] = sigma[box_with(centre + i * axes, axes)];
  terms.sigma.cell = sigma;
  pair p = {.yee = box_march(&terms), .count = dvi_mesh_count(mesh, terms.degree)};
  ck_assert_int_eq(dvi_march_size(p.yee, DVI_FORM_E), p.count);
  match_cells(&p, mesh, &terms);
  p.field = electric(
      mesh, DVI_CIRCUMCENTRIC, NULL,
      (dvi_maxwell_terms){
          .scalar = terms.degree == 0, .wall = &wall, .walls = has_pec, .conductivity = by_cell});
  p.leapfrog = march_of(p.field, (dvi_march_options){.step = step}, NULL, NULL);
  free(sigma), free(by_cell), free(centre);
  start_pair(&p);
  return p;
}

static void end_pair(pair *p)
{
  dvi_march_destroy(&p->yee), dvi_march_destroy(&p->leapfrog);
  dvi_field_destroy(&p->field);
  free(p->place), free(p->sign);
}

static double *judge_at(const pair *p, double t)
{
  advance_march(p->leapfrog, t);
  return sample_march(p->leapfrog, DVI_FORM_E);
}

/* At the middle of a step samples are the state. */
START_TEST(conductors_take_starts_and_steps_as_leapfrog_does)
{
  pair p = make_pair(_i, 1e9);
  for (int n = 0; n < STEPS; n++) {
    const double t = (n + 0.5) * step;
    advance_march(p.yee, t);
    double *E = sample_march(p.yee, DVI_FORM_E), *judge = judge_at(&p, t);
    for (int64_t i = 0; i < p.count; i++)
      ck_assert_double_eq_tol(p.sign[i] * E[p.place[i]], judge[i], 1e-12);
    free(E), free(judge);
  }
  end_pair(&p);
}
END_TEST

/* Give leapfrog's samples at the start, in the middle, and at the end of a step. */
static void judge_step(const pair *p, int n, double *judge[3])
{
  for (int i = 0; i < 3; i++) judge[i] = judge_at(p, (n + 0.5 * i) * step);
}

/* Over a step samples of both are the start, the state in the middle, and the end. Between these
 * yee takes B at the time, and so its samples lie on the parabola through them. */
START_TEST(samples_of_conductors_are_those_of_leapfrog)
{
  static const double parts[] = {0, 0.1, 0.25, 0.4, 0.5, 0.6, 0.9, 0.999};
  pair p = make_pair(_i % GRIDS, _i < GRIDS ? 1e4 : 1e9);
  for (int n = 0; n < STEPS; n++) {
    double *judge[3];
    judge_step(&p, n, judge);
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
      const double x = parts[k];
      advance_march(p.yee, (n + x) * step);
      double *E = sample_march(p.yee, DVI_FORM_E);
      for (int64_t i = 0; i < p.count; i++)
        ck_assert_double_eq_tol(p.sign[i] * E[p.place[i]],
                                (1 - x) * (1 - 2 * x) * judge[0][i] +
                                    4 * x * (1 - x) * judge[1][i] + x * (2 * x - 1) * judge[2][i],
                                1e-12);
      free(E);
    }
    for (int i = 0; i < 3; i++) free(judge[i]);
  }
  end_pair(&p);
}
END_TEST

SUITE(yee_losses)
{
  tcase_add_loop_test(tests, samples_of_conductors_are_those_of_leapfrog, 0, 2 * GRIDS);
  tcase_add_loop_test(tests, conductors_take_starts_and_steps_as_leapfrog_does, 0, GRIDS);
}
