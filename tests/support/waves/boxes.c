#include "support/waves/boxes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"

/* ---- marches ---- */

dvi_march *box_march(const dvi_yee_terms *terms)
{
  dvi_march *march = NULL;
  ck_assert_msg(dvi_yee_create(terms, &march) == DVI_OK, "%s", dvi_last_error());
  return march;
}

void start_boxes(dvi_march *march, const double *E, const double *B)
{
  const dvi_march_state state = {.size = sizeof state, .E = E, .B = B};
  ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
}

double *random_values(int64_t count, unsigned long long seed)
{
  double *values = calloc((size_t)count + 1, sizeof *values);
  for (int64_t i = 0; i < count; i++) values[i] = 2 * random_number(&seed) - 1;
  return values;
}

/* ---- judge ---- */

static int repeats_itself(const dvi_yee_axis *axis)
{
  return axis->end[0].kind == DVI_YEE_PERIODIC;
}

static double coordinate(const dvi_yee_axis *axis, int i)
{
  const double upper = axis->lower == 0 && axis->upper == 0 ? 1 : axis->upper;
  return axis->node != NULL ? axis->node[i] : axis->lower + (upper - axis->lower) * i / axis->cells;
}

static double length(const dvi_yee_terms *terms, int axis, int i)
{
  const dvi_yee_axis *a = &terms->axis[axis];
  const int n = a->cells;
  if (axis >= terms->axes) return 1;
  if (repeats_itself(a)) i = (i + n) % n;
  return i < 0 || i >= n ? 0 : coordinate(a, i + 1) - coordinate(a, i);
}

static double dual_length(const dvi_yee_terms *terms, int axis, int i)
{
  if (axis >= terms->axes) return 1;
  return 0.5 * (length(terms, axis, i - 1) + length(terms, axis, i));
}

static int is_wall(const dvi_yee_terms *terms, int axis, int i)
{
  const dvi_yee_axis *a = &terms->axis[axis];
  if (axis >= terms->axes) return 0;
  return (i == 0 && a->end[0].kind == DVI_YEE_PEC) ||
         (i == a->cells && a->end[1].kind == DVI_YEE_PEC);
}

/* Give the number of an edge one node further along an axis. */
static int64_t edge_after(const dvi_yee_terms *terms, int component, const int *place, int axis)
{
  int next[3] = {place[0], place[1], place[2]};
  if (axis >= terms->axes) return dvi_yee_place(terms, DVI_FORM_E, component, place);
  next[axis]++;
  if (repeats_itself(&terms->axis[axis])) next[axis] %= terms->axis[axis].cells;
  return dvi_yee_place(terms, DVI_FORM_E, component, next);
}

static void judge_face(box_judge *judge, const dvi_yee_terms *terms, int c, const int *place)
{
  const int64_t face = dvi_yee_place(terms, DVI_FORM_B, c, place);
  const int a = (c + 1) % 3, b = (c + 2) % 3;
  if (face < 0) return;
  const int64_t edge[4] = {
      edge_after(terms, b, place, a), dvi_yee_place(terms, DVI_FORM_E, b, place),
      edge_after(terms, a, place, b), dvi_yee_place(terms, DVI_FORM_E, a, place)};
  judge->M2[face] = 1;
  for (int l = 0; l < 3; l++)
    judge->M2[face] *= l == c ? dual_length(terms, l, place[l]) : 1 / length(terms, l, place[l]);
  for (int i = 0; i < 4; i++) {
    judge->boundary[4 * face + i] = (int)edge[i];
    judge->sign[4 * face + i] = i == 0 || i == 3 ? 1 : -1;
  }
}

static void judge_edge(box_judge *judge, const dvi_yee_terms *terms, int c, const int *place)
{
  const int64_t edge = dvi_yee_place(terms, DVI_FORM_E, c, place);
  if (edge < 0) return;
  judge->M1[edge] = judge->is_free[edge] = 1;
  for (int l = 0; l < 3; l++) {
    judge->M1[edge] *= l == c ? 1 / length(terms, l, place[l]) : dual_length(terms, l, place[l]);
    if (l != c && is_wall(terms, l, place[l])) judge->is_free[edge] = 0;
  }
}

box_judge make_judge(const dvi_yee_terms *terms)
{
  box_judge judge = {.edges = dvi_yee_size(terms, DVI_FORM_E),
                     .faces = dvi_yee_size(terms, DVI_FORM_B)};
  const size_t edges = (size_t)judge.edges, faces = (size_t)judge.faces;
  int most[3] = {0, 0, 0}, place[3];
  judge.boundary = calloc(4 * faces, sizeof *judge.boundary);
  judge.sign = calloc(4 * faces, sizeof *judge.sign);
  judge.M1 = calloc(edges, sizeof *judge.M1);
  judge.M2 = calloc(faces, sizeof *judge.M2);
  judge.is_free = calloc(edges, sizeof *judge.is_free);
  judge.E = calloc(edges, sizeof *judge.E);
  judge.B = calloc(faces, sizeof *judge.B);
  for (int l = 0; l < terms->axes; l++) most[l] = terms->axis[l].cells;
  for (int c = 0; c < 3; c++)
    for (place[2] = 0; place[2] <= most[2]; place[2]++)
      for (place[1] = 0; place[1] <= most[1]; place[1]++)
        for (place[0] = 0; place[0] <= most[0]; place[0]++) {
          judge_face(&judge, terms, c, place);
          judge_edge(&judge, terms, c, place);
        }
  return judge;
}

void free_judge(box_judge *judge)
{
  free(judge->boundary);
  free(judge->sign);
  free(judge->M1);
  free(judge->M2);
  free(judge->is_free);
  free(judge->E);
  free(judge->B);
}

static double curl(const box_judge *judge, const double *E, int64_t face)
{
  double sum = 0;
  for (int i = 0; i < 4; i++) {
    const int edge = judge->boundary[4 * face + i];
    sum += edge >= 0 ? judge->sign[4 * face + i] * E[edge] : 0;
  }
  return sum;
}

/* Add factor M_1^-1 d^T M_2 B to E. */
static void add_curl(const box_judge *judge, double factor, const double *B, double *E)
{
  for (int64_t f = 0; f < judge->faces; f++)
    for (int i = 0; i < 4; i++) {
      const int edge = judge->boundary[4 * f + i];
      if (edge >= 0 && judge->is_free[edge])
        E[edge] += factor * judge->sign[4 * f + i] * judge->M2[f] * B[f] / judge->M1[edge];
    }
}

void start_judge(box_judge *judge, const double *E, const double *B, double dt)
{
  for (int64_t e = 0; e < judge->edges; e++) judge->E[e] = judge->is_free[e] ? E[e] : 0;
  memcpy(judge->B, B, (size_t)judge->faces * sizeof *B);
  add_curl(judge, 0.5 * dt, judge->B, judge->E);
}

void step_judge(box_judge *judge, double dt)
{
  for (int64_t f = 0; f < judge->faces; f++) judge->B[f] -= dt * curl(judge, judge->E, f);
  add_curl(judge, dt, judge->B, judge->E);
}

double largest_of_judge(const box_judge *judge)
{
  double *x = random_values(judge->edges, 7), *b = calloc((size_t)judge->faces, sizeof *b),
         largest = 0;
  for (int64_t e = 0; e < judge->edges; e++) x[e] *= judge->is_free[e];
  for (int n = 0; n < 4000; n++) {
    double norm = 0;
    for (int64_t f = 0; f < judge->faces; f++) b[f] = curl(judge, x, f);
    memset(x, 0, (size_t)judge->edges * sizeof *x);
    add_curl(judge, 1, b, x);
    for (int64_t e = 0; e < judge->edges; e++) norm += judge->M1[e] * x[e] * x[e];
    largest = sqrt(norm);
    for (int64_t e = 0; e < judge->edges; e++) x[e] /= largest;
  }
  free(x);
  free(b);
  return largest;
}
