#include "support/field/steps.h"

#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "support/meshes.h"
#include "support/suite.h"

stepped stepped_mesh(dvi_mesh *mesh, int k, int is_fixed)
{
  stepped s = {.mesh = mesh};
  dvi_matrix d, below = {0}, M1, M2;
  int64_t count;
  ck_assert_msg(dvi_star_create(mesh, NULL, &s.star) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_star_matrix(s.star, k, &M1), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(s.star, k + 1, &M2), DVI_OK);
  ck_assert_int_eq(dvi_mesh_incidence(mesh, k, &d), DVI_OK);
  if (k > 0) ck_assert_int_eq(dvi_mesh_incidence(mesh, k - 1, &below), DVI_OK);
  s.edges = d.columns;
  s.faces = d.rows;
  s.nodes = below.columns;
  s.is_fixed = calloc((size_t)s.edges, 1);
  const int *boundary = dvi_mesh_part_cells(mesh, "boundary", k, &count);
  for (int64_t i = 0; i < count && is_fixed; i++) s.is_fixed[boundary[i]] = 1;
  s.terms = (dvi__avi_terms){.edges = s.edges,
                             .faces = s.faces,
                             .width = d.width,
                             .facet = d.column,
                             .sign = d.sign,
                             .M1 = M1.value,
                             .M2 = M2.value,
                             .is_fixed = s.is_fixed,
                             .nodes = s.nodes,
                             .node_width = below.width,
                             .node = below.column,
                             .node_sign = below.sign};
  return s;
}

void end_stepped(stepped *s)
{
  free(s->is_fixed);
  dvi_star_destroy(&s->star);
  dvi_mesh_destroy(&s->mesh);
}

void step_of_boxes(const dvi_mesh *mesh, double fraction, int is_free, double *step)
{
  int width;
  const int *vertex = dvi_mesh_vertices(mesh, 2, &width);
  const double *point = dvi_mesh_points(mesh);
  const int64_t count = dvi_mesh_count(mesh, 2);
  double shortest = INFINITY;
  for (int64_t f = 0; f < count; f++) {
    const double *near = point + 2 * vertex[f * width], *far = point + 2 * vertex[f * width + 3];
    step[f] = fraction / hypot(1 / (far[0] - near[0]), 1 / (far[1] - near[1]));
    shortest = fmin(shortest, step[f]);
  }
  for (int64_t f = 0; f < count && !is_free; f++)
    step[f] = shortest * exp2(floor(log2(step[f] / shortest) + 1e-12));
}

void start_at_random(const stepped *s, dvi__avi *avi, unsigned long long seed)
{
  double *E = calloc((size_t)s->edges, sizeof *E);
  for (int64_t e = 0; e < s->edges; e++) E[e] = 2 * random_number(&seed) - 1;
  ck_assert_msg(dvi__avi_start(avi, 0, NULL, E, NULL) == DVI_OK, "%s", dvi_last_error());
  free(E);
}

dvi__avi *avi_of(const dvi__avi_terms *terms)
{
  dvi__avi *avi = NULL;
  ck_assert_msg(dvi__avi_create(terms, &avi) == DVI_OK, "%s", dvi_last_error());
  return avi;
}

double energy_of(const dvi__avi *avi)
{
  double energy;
  ck_assert_msg(dvi__avi_energy(avi, &energy, NULL) == DVI_OK, "%s", dvi_last_error());
  return energy;
}

void advance_to(dvi__avi *avi, double t)
{
  ck_assert_msg(dvi__avi_advance(avi, t) == DVI_OK, "%s", dvi_last_error());
}

double *zeros(int64_t count)
{
  return calloc((size_t)count + 1, sizeof(double));
}

/* ---- loads ---- */

/* The exact integral of cos(3 t). */
static dvi_status cosine(double from, double to, double *impulse, void *user)
{
  (void)user;
  *impulse = (sin(3 * to) - sin(3 * from)) / 3;
  return DVI_OK;
}

dvi_status noise_signal(double from, double to, double *impulse, void *user)
{
  unsigned long long seed = (unsigned long long)(1e9 * (from + to));
  (void)user;
  (void)random_number(&seed);
  *impulse = (to - from) * (2 * random_number(&seed) - 1);
  return DVI_OK;
}

void load_steps(loaded *l, int currents, double damping)
{
  unsigned long long seed = 11;
  l->damping = zeros(l->s.edges);
  for (int i = 0; i < 2; i++) l->profile[i] = zeros(l->s.edges);
  for (int64_t e = 0; e < l->s.edges; e += 3) {
    l->damping[e] = damping * l->s.terms.M1[e] * random_number(&seed);
    for (int i = 0; i < 2; i++) l->profile[i][e] = l->s.terms.M1[e] * (random_number(&seed) - 0.5);
  }
  for (int i = 0; i < 2; i++)
    l->current[i] = (dvi__avi_current){l->profile[i], i == 0 ? cosine : noise_signal, NULL};
  l->s.terms.current = l->current;
  l->s.terms.currents = currents;
  l->s.terms.damping = l->damping;
}

void end_loaded(loaded *l)
{
  end_stepped(&l->s);
  free(l->damping);
  for (int i = 0; i < 2; i++) free(l->profile[i]);
}

stepped mesh_of_case(int i)
{
  switch (i) {
  case 0: return stepped_mesh(grid_mesh("box", 2, 6, 2), 1, 1);
  case 1: return stepped_mesh(staggered_mesh(6, 5), 1, 1);
  case 2: return stepped_mesh(grid_mesh("interval", 1, 12, 2), 0, 1);
  case 3: return stepped_mesh(grid_mesh("box", 3, 4, 1.7), 1, 0);
  default: return stepped_mesh(grid_mesh("kuhn", 2, 6, 1.5), 0, 0);
  }
}

/* ---- values ---- */

void take_form(const dvi__avi *avi, dvi_march_form form, double *values)
{
  ck_assert_msg(dvi__avi_sample(avi, form, 0, NULL, values) == DVI_OK, "%s", dvi_last_error());
}

double *forms_of(const stepped *s, const dvi__avi *avi)
{
  double *values = zeros(2 * s->edges + s->faces);
  take_form(avi, DVI_FORM_A, values);
  take_form(avi, DVI_FORM_E, values + s->edges);
  take_form(avi, DVI_FORM_B, values + 2 * s->edges);
  return values;
}

void check_same(const stepped *s, const dvi__avi *a, const dvi__avi *b)
{
  double *of_a = forms_of(s, a), *of_b = forms_of(s, b);
  for (int64_t i = 0; i < 2 * s->edges + s->faces; i++)
    ck_assert_msg(of_a[i] == of_b[i], "value %lld: %.17g and %.17g", (long long)i, of_a[i],
                  of_b[i]);
  free(of_a), free(of_b);
}

dvi__avi *ran_steps(const dvi__avi_terms *terms, const stepped *s, double t)
{
  dvi__avi *avi = avi_of(terms);
  start_at_random(s, avi, 7);
  advance_to(avi, t);
  return avi;
}

void run_string(int is_free, double damping, double fraction, double *values)
{
  static const double pi = 3.14159265358979323846;
  loaded l = {.s = mesh_of_case(2)};
  load_steps(&l, 1, damping);
  l.s.terms.fraction = fraction;
  l.s.terms.is_free = is_free;
  double *A = zeros(l.s.edges);
  const double *x = dvi_mesh_points(l.s.mesh);
  dvi__avi *avi = avi_of(&l.s.terms);
  for (int64_t e = 0; e < l.s.edges; e++) A[e] = sin(pi * x[e]);
  ck_assert_int_eq(dvi__avi_start(avi, 0.5, A, NULL, NULL), DVI_OK);
  advance_to(avi, 1.7);
  take_form(avi, DVI_FORM_A, values);
  take_form(avi, DVI_FORM_E, values + l.s.edges);
  take_form(avi, DVI_FORM_B, values + 2 * l.s.edges);
  dvi__avi_destroy(&avi);
  free(A);
  end_loaded(&l);
}

double string_error(int is_free, double damping, double fraction, const double *exact)
{
  double values[STRING_VALUES], worst = 0;
  run_string(is_free, damping, fraction, values);
  for (int i = 0; i < STRING_VALUES; i++) worst = fmax(worst, fabs(values[i] - exact[i]));
  return worst;
}

void reload_steps(const dvi__avi *from, dvi__avi *to)
{
  dvi__sections_writer writer;
  dvi__sections sections = {0};
  dvi__sections_start(&writer, 100);
  dvi__avi_save(from, &writer);
  ck_assert_int_eq(dvi__sections_finish(&writer), DVI_OK);
  ck_assert_int_eq(dvi__sections_check(&sections, "state", writer.bytes, writer.size), DVI_OK);
  ck_assert_msg(dvi__avi_load(to, &sections) == DVI_OK, "%s", dvi_last_error());
  dvi__sections_clear(&sections);
  dvi__release(writer.bytes);
}
