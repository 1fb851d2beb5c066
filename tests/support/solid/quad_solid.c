#include "support/solid/quad_solid.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS = 4, SPACE = 3 };

static void *room_for(size_t count, size_t size)
{
  void *room = calloc(count > 0 ? count : 1, size);
  ck_assert_ptr_nonnull(room);
  return room;
}

/* ---- small matrices [n*n], row by row ---- */

static quad determinant(int n, const quad *A)
{
  if (n == 2) return A[0] * A[3] - A[1] * A[2];
  return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
         A[2] * (A[3] * A[7] - A[4] * A[6]);
}

/* The transposed cofactors, A^-1 det A. */
static void adjugate(int n, const quad *A, quad *B)
{
  if (n == 2) {
    B[0] = A[3], B[1] = -A[1], B[2] = -A[2], B[3] = A[0];
    return;
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const int r = (j + 1) % 3, s = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      B[i * 3 + j] = A[r * 3 + c] * A[s * 3 + d] - A[r * 3 + d] * A[s * 3 + c];
    }
}

static quad trace(int n, const quad *A)
{
  quad sum = 0;
  for (int i = 0; i < n; i++) sum += A[i * n + i];
  return sum;
}

static quad product(int count, const quad *a, const quad *b)
{
  quad sum = 0;
  for (int i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

/* C = F^T F. */
static void stretch(int n, const quad *F, quad *C)
{
  for (int i = 0; i < n; i++)
    for (int j = i; j < n; j++) {
      quad sum = 0;
      for (int k = 0; k < n; k++) sum += F[k * n + i] * F[k * n + j];
      C[i * n + j] = C[j * n + i] = sum;
    }
}

static void multiply(int n, const quad *A, const quad *B, quad *result)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      quad sum = 0;
      for (int k = 0; k < n; k++) sum += A[i * n + k] * B[k * n + j];
      result[i * n + j] = sum;
    }
}

/* ---- laws ---- */

/* P and W of lambda (tr e)^2/2 + mu e:e at a symmetric strain e, whose P is symmetric. */
static quad hooke(int n, const dvi_elastic_material *m, const quad *e, quad *P)
{
  const quad lambda = m->lambda, mu = m->mu, tr = trace(n, e);
  for (int i = 0; i < n * n; i++) P[i] = 2 * mu * e[i];
  for (int i = 0; i < n; i++) P[i * n + i] += lambda * tr;
  return lambda * tr * tr / 2 + mu * product(n * n, e, e);
}

static quad linear(int n, const dvi_elastic_material *m, const quad *F, quad *P)
{
  quad e[9] = {0};
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) e[i * n + j] = (F[i * n + j] + F[j * n + i]) / 2 - (i == j);
  return hooke(n, m, e, P);
}

static quad svk(int n, const dvi_elastic_material *m, const quad *F, quad *P)
{
  quad E[9] = {0}, S[9] = {0};
  stretch(n, F, E);
  for (int i = 0; i < n; i++) E[i * n + i] -= 1;
  for (int i = 0; i < n * n; i++) E[i] /= 2;
  const quad W = hooke(n, m, E, S);
  multiply(n, F, S, P);
  return W;
}

/* With C_33 = 1 in a plane. mooney = 0 is the neo-Hookean law: the others' invariants of a plane
 * differ from its tr C by a constant, which W has not. */
static quad mooney_rivlin(int n, const dvi_elastic_material *m, quad mooney, const quad *F, quad *P)
{
  const quad lambda = m->lambda, mu = m->mu, J = determinant(n, F), log_J = quad_log(J);
  quad C[9] = {0}, FC[9] = {0}, inverse[9] = {0};
  stretch(n, F, C);
  multiply(n, F, C, FC);
  adjugate(n, F, inverse);
  const quad I1 = trace(n, C) + (3 - n), I2 = (I1 * I1 - product(n * n, C, C) - (3 - n)) / 2;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      const int ij = i * n + j;
      P[ij] = (mu - mooney) * F[ij] + mooney * (I1 * F[ij] - FC[ij]) +
              ((lambda - 2 * mooney) * log_J - (mu + mooney)) * inverse[j * n + i] / J;
    }
  return (mu - mooney) / 2 * (I1 - 3) + mooney / 2 * (I2 - 3) - (mu + mooney) * log_J +
         (lambda - 2 * mooney) / 2 * log_J * log_J;
}

static quad store(int n, const dvi_elastic_material *m, dvi_elastic_law law, const quad *F, quad *P)
{
  switch (law) {
  case DVI_ELASTIC_LINEAR: return linear(n, m, F, P);
  case DVI_ELASTIC_SVK: return svk(n, m, F, P);
  case DVI_ELASTIC_NEO_HOOKEAN: return mooney_rivlin(n, m, 0, F, P);
  case DVI_ELASTIC_MOONEY_RIVLIN: return mooney_rivlin(n, m, m->mooney, F, P);
  case DVI_ELASTIC_ENERGY: break;
  }
  ck_abort_msg("the judge knows only laws with a name");
  return 0;
}

/* ---- cells ---- */

quad quad_solid_cell(const quad_solid *s, int cell, int is_linear, const quad *u, quad *f)
{
  const int n = s->n;
  const quad *gradient = s->gradient + (size_t)cell * (size_t)(n + 1) * (size_t)n;
  const dvi_elastic_material *m = &s->material[cell];
  quad F[9] = {0}, P[9] = {0};
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++)
      for (int a = 0; a <= n; a++) F[i * n + j] += u[a * n + i] * gradient[a * n + j];
    F[i * n + i] += 1;
  }
  const quad W = store(n, m, is_linear ? DVI_ELASTIC_LINEAR : m->law, F, P);
  for (int a = 0; a <= n; a++)
    for (int i = 0; i < n; i++)
      f[a * n + i] = -s->volume[cell] * product(n, P + i * n, gradient + a * n);
  return s->volume[cell] * W;
}

static void add_shape(quad_solid *s, int cell)
{
  const int n = s->n, *vertex = s->vertex + cell * (n + 1);
  quad edge[9] = {0}, inverse[9] = {0}, *gradient = s->gradient + (size_t)(cell * (n + 1) * n);
  for (int a = 0; a < n; a++)
    for (int j = 0; j < n; j++)
      edge[a * n + j] = s->point[vertex[a + 1] * n + j] - s->point[vertex[0] * n + j];
  const quad det = determinant(n, edge);
  adjugate(n, edge, inverse);
  for (int j = 0; j < n; j++) {
    gradient[j] = 0;
    for (int a = 0; a < n; a++) {
      gradient[(a + 1) * n + j] = inverse[j * n + a] / det;
      gradient[j] -= inverse[j * n + a] / det;
    }
  }
  s->volume[cell] = quad_abs(det) / (n == 2 ? 2 : 6);
}

/* ---- what is declared ---- */

static void take_materials(quad_solid *s, const dvi_elastic_terms *terms)
{
  for (int i = 0; i < terms->materials; i++) {
    int64_t count = 0;
    const int *cell = dvi_mesh_part_cells(terms->mesh, terms->material[i].part, s->n, &count);
    for (int64_t c = 0; c < count; c++) s->material[cell[c]] = terms->material[i];
  }
  for (int cell = 0; cell < s->cells; cell++)
    for (int a = 0; a <= s->n; a++)
      s->mass[s->vertex[cell * (s->n + 1) + a]] += s->material[cell].rho * s->volume[cell] /
                                                   (s->n + 1);
}

static void at_rest(quad t, const quad *X, quad *u, quad *rate)
{
  (void)t, (void)X;
  for (int i = 0; i < SPACE; i++) u[i] = rate[i] = 0;
}

/* The first condition on a component counts, so the last one is taken first. */
static void take_conditions(quad_solid *s, const dvi_elastic_terms *terms,
                            quad_displacement *const *displacement)
{
  for (int i = terms->conditions - 1; i >= 0; i--) {
    const dvi_elastic_condition *condition = &terms->condition[i];
    const int *component = condition->component;
    const int is_all = !component[0] && !component[1] && !(s->n == 3 && component[2]);
    int64_t count = 0;
    const int *vertex = dvi_mesh_part_cells(terms->mesh, condition->part, 0, &count);
    for (int64_t v = 0; v < count; v++)
      for (int j = 0; j < s->n; j++)
        if (is_all || component[j])
          s->given[vertex[v] * s->n + j] = displacement && displacement[i] ? displacement[i]
                                                                           : at_rest;
  }
}

/* Mark the corners of a facet in a cell. Returns 0 if the cell lacks one of them. */
static unsigned corners_of(const quad_solid *s, int cell, const int *facet)
{
  unsigned nodes = 0;
  int found = 0;
  for (int a = 0; a <= s->n; a++)
    for (int b = 0; b < s->n; b++)
      if (s->vertex[cell * (s->n + 1) + a] == facet[b]) nodes |= 1U << a, found++;
  return found == s->n ? nodes : 0;
}

static void set_centre(const quad_solid *s, quad_solid_load *load)
{
  int count = 0;
  for (int a = 0; a <= s->n; a++)
    if (load->nodes >> a & 1) {
      for (int j = 0; j < s->n; j++)
        load->at[j] += s->point[s->vertex[load->cell * (s->n + 1) + a] * s->n + j];
      count++;
    }
  for (int j = 0; j < s->n; j++) load->at[j] /= count;
  load->weight /= count;
}

/* The gradient of the node opposite to a facet is -normal/altitude, and area = n V/altitude. */
static void take_facet(quad_solid *s, quad_load *force, const int *facet)
{
  quad_solid_load load = {.force = force};
  while (load.cell < s->cells && !(load.nodes = corners_of(s, load.cell, facet))) load.cell++;
  ck_assert_int_lt(load.cell, s->cells);
  int opposite = 0;
  while (load.nodes >> opposite & 1) opposite++;
  const quad *gradient = s->gradient + (load.cell * (s->n + 1) + opposite) * s->n;
  const quad length = quad_sqrt(product(s->n, gradient, gradient));
  for (int j = 0; j < s->n; j++) load.normal[j] = -gradient[j] / length;
  load.weight = s->n * s->volume[load.cell] * length;
  set_centre(s, &load);
  s->load[s->loads++] = load;
}

static void take_load(quad_solid *s, const dvi_mesh *mesh, const char *part, quad_load *force)
{
  int64_t count = 0;
  const int *cell = dvi_mesh_part_cells(mesh, part, s->n, &count);
  const int is_body = count > 0, *facet = dvi_mesh_vertices(mesh, s->n - 1, NULL);
  if (!is_body) cell = dvi_mesh_part_cells(mesh, part, s->n - 1, &count);
  s->load = realloc(s->load, (size_t)(s->loads + count + 1) * sizeof *s->load);
  for (int64_t c = 0; c < count; c++)
    if (is_body) {
      quad_solid_load load = {.force = force,
                              .cell = cell[c],
                              .nodes = (1U << (s->n + 1)) - 1,
                              .weight = s->volume[cell[c]]};
      set_centre(s, &load);
      s->load[s->loads++] = load;
    } else {
      take_facet(s, force, facet + (size_t)cell[c] * (size_t)s->n);
    }
}

quad_solid quad_solid_of(const dvi_elastic_terms *terms, quad_displacement *const *displacement,
                         quad_load *const *load)
{
  quad_solid s = {.n = dvi_mesh_dimension(terms->mesh),
                  .vertices = (int)dvi_mesh_count(terms->mesh, 0)};
  const size_t n = (size_t)s.n;
  s.cells = (int)dvi_mesh_count(terms->mesh, s.n);
  s.size = s.vertices * s.n;
  s.vertex = dvi_mesh_vertices(terms->mesh, s.n, NULL);
  s.point = room_for((size_t)s.size, sizeof *s.point);
  s.gradient = room_for((size_t)s.cells * (n + 1) * n, sizeof *s.gradient);
  s.volume = room_for((size_t)s.cells, sizeof *s.volume);
  s.mass = room_for((size_t)s.vertices, sizeof *s.mass);
  s.material = room_for((size_t)s.cells, sizeof *s.material);
  s.given = room_for((size_t)s.size, sizeof *s.given);
  for (int i = 0; i < s.size; i++) s.point[i] = dvi_mesh_points(terms->mesh)[i];
  for (int cell = 0; cell < s.cells; cell++) add_shape(&s, cell);
  take_materials(&s, terms);
  take_conditions(&s, terms, displacement);
  for (int i = 0; i < terms->loads; i++)
    if (load && load[i]) take_load(&s, terms->mesh, terms->load[i].part, load[i]);
  return s;
}

void quad_solid_clear(quad_solid *s)
{
  free(s->point), free(s->gradient), free(s->volume), free(s->mass);
  free(s->material), free(s->given), free(s->load);
  *s = (quad_solid){0};
}

/* ---- equations of motion ---- */

void quad_solid_give(const quad_solid *s, quad t, quad *u, quad *rate)
{
  quad displacement[SPACE] = {0}, speed[SPACE] = {0};
  for (int i = 0; i < s->size; i++) {
    if (!s->given[i]) continue;
    s->given[i](t, s->point + i - i % s->n, displacement, speed);
    u[i] = displacement[i % s->n];
    if (rate) rate[i] = speed[i % s->n];
  }
}

static void gather(const quad_solid *s, int cell, const quad *all, quad *own)
{
  const int n = s->n, *vertex = s->vertex + cell * (n + 1);
  for (int a = 0; a <= n; a++)
    for (int i = 0; i < n; i++) own[a * n + i] = all[vertex[a] * n + i];
}

/* The law at F = I + grad w has the force of a linear one at the rate w. */
static void add_damping(const quad_solid *s, int cell, const quad *v, quad *f)
{
  const dvi_elastic_material *m = &s->material[cell];
  const quad mass = m->rho * s->volume[cell] / (s->n + 1);
  quad own[CORNERS * SPACE] = {0}, pull[CORNERS * SPACE] = {0};
  gather(s, cell, v, own);
  if (m->beta > 0) (void)quad_solid_cell(s, cell, 1, own, pull);
  for (int i = 0; i < (s->n + 1) * s->n; i++) f[i] += m->beta * pull[i] - m->alpha * mass * own[i];
}

static void scatter(const quad_solid *s, int cell, const quad *f, quad *all)
{
  const int n = s->n, *vertex = s->vertex + cell * (n + 1);
  for (int a = 0; a <= n; a++)
    for (int i = 0; i < n; i++) all[vertex[a] * n + i] += f[a * n + i];
}

static void add_load(const quad_solid *s, const quad_solid_load *load, quad t, quad *all)
{
  quad force[SPACE];
  load->force(t, load->at, load->normal, force);
  for (int a = 0; a <= s->n; a++)
    if (load->nodes >> a & 1)
      for (int j = 0; j < s->n; j++)
        all[s->vertex[load->cell * (s->n + 1) + a] * s->n + j] += load->weight * force[j];
}

void quad_solid_accelerate(const quad_solid *s, quad t, const quad *u, const quad *v, quad *a)
{
  memset(a, 0, (size_t)s->size * sizeof *a);
  for (int cell = 0; cell < s->cells; cell++) {
    quad own[CORNERS * SPACE] = {0}, f[CORNERS * SPACE] = {0};
    gather(s, cell, u, own);
    (void)quad_solid_cell(s, cell, 0, own, f);
    if (s->material[cell].alpha > 0 || s->material[cell].beta > 0) add_damping(s, cell, v, f);
    scatter(s, cell, f, a);
  }
  for (int i = 0; i < s->loads; i++) add_load(s, &s->load[i], t, a);
  for (int i = 0; i < s->size; i++) a[i] = s->given[i] ? 0 : a[i] / s->mass[i / s->n];
}

/* ---- Gragg's rule, extrapolated (Hairer, Norsett and Wanner 1993, sec. II.9) ---- */

enum { COLUMNS = 10 };

typedef struct table {
  quad *row[COLUMNS], *rate, *before, *here, *last; /* [2 size] u and v */
} table;

/* Set the rate of y = (u, v), after what is given was set. */
static void evaluate(const quad_solid *s, quad t, quad *y, quad *rate)
{
  quad_solid_give(s, t, y, y + s->size);
  memcpy(rate, y + s->size, (size_t)s->size * sizeof *rate);
  quad_solid_accelerate(s, t, y, y + s->size, rate + s->size);
}

static void midpoint(const quad_solid *s, const table *w, quad t, const quad *y, quad h, int count,
                     quad *end)
{
  const quad substep = h / count;
  for (int i = 0; i < 2 * s->size; i++) w->before[i] = y[i];
  for (int i = 0; i < 2 * s->size; i++) end[i] = y[i] + substep * w->rate[i];
  for (int step = 1; step < count; step++) {
    evaluate(s, t + step * substep, end, w->here);
    for (int i = 0; i < 2 * s->size; i++) {
      const quad next = w->before[i] + 2 * substep * w->here[i];
      w->before[i] = end[i];
      end[i] = next;
    }
  }
  quad_solid_give(s, t + h, end, end + s->size);
}

/* Take a step of y, whose result is w->row[0]. Returns the difference of the last two columns. */
static quad extrapolate(const quad_solid *s, const table *w, quad t, quad *y, quad h)
{
  quad most = 0;
  evaluate(s, t, y, w->rate);
  for (int j = 0; j < COLUMNS; j++) {
    midpoint(s, w, t, y, h, 2 * (j + 1), w->row[j]);
    for (int k = j - 1; k >= 0; k--) { /* row[k] becomes the entry that uses substeps k .. j */
      const quad ratio = (quad)(j + 1) / (k + 1), by = 1 / (ratio * ratio - 1);
      if (k == 0 && j == COLUMNS - 1)
        memcpy(w->last, w->row[1], 2 * (size_t)s->size * sizeof *w->last);
      for (int i = 0; i < 2 * s->size; i++)
        w->row[k][i] = w->row[k + 1][i] + (w->row[k + 1][i] - w->row[k][i]) * by;
    }
  }
  for (int i = 0; i < s->size; i++) {
    const quad difference = quad_abs(w->row[0][i] - w->last[i]);
    if (!(difference <= most)) most = difference;
  }
  return most;
}

static table table_of(size_t count)
{
  table w = {.rate = room_for(count, sizeof(quad)),
             .before = room_for(count, sizeof(quad)),
             .here = room_for(count, sizeof(quad)),
             .last = room_for(count, sizeof(quad))};
  for (int j = 0; j < COLUMNS; j++) w.row[j] = room_for(count, sizeof(quad));
  return w;
}

static void table_clear(table *w)
{
  for (int j = 0; j < COLUMNS; j++) free(w->row[j]);
  free(w->rate), free(w->before), free(w->here), free(w->last);
}

double quad_solid_advance(const quad_solid *s, quad from, quad to, quad *u, quad *v)
{
  const size_t size = (size_t)s->size;
  const quad tolerance = quad_parse("1e-21", NULL);
  table w = table_of(2 * size);
  quad *y = room_for(2 * size, sizeof *y), t = from, h = to - from, error = 0;
  memcpy(y, u, size * sizeof *y);
  memcpy(y + size, v, size * sizeof *y);
  while (t < to) {
    if (h > to - t) h = to - t;
    const quad estimate = extrapolate(s, &w, t, y, h);
    const double ratio = (double)(estimate / tolerance);
    if (ratio <= 1) {
      memcpy(y, w.row[0], 2 * size * sizeof *y);
      error += estimate;
      t = h < to - t ? t + h : to;
    }
    const double factor = 0.9 * pow(ratio + 1e-12, -1.0 / (2 * COLUMNS - 1));
    h *= (quad)(factor > 0.2 ? fmin(factor, 2.0) : 0.2);
    ck_assert_msg((double)h > 1e-9, "the judge takes steps of %g at t = %g", (double)h, (double)t);
  }
  memcpy(u, y, size * sizeof *y);
  memcpy(v, y + size, size * sizeof *y);
  table_clear(&w);
  free(y);
  return (double)error;
}
