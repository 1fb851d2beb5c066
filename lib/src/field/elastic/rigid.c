#include "field/elastic/rigid.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/connected.h"
#include "num/eigen.h"

enum { MOTIONS = DVI__RIGID_MOTIONS, AXES = DVI_ELASTIC_DIMENSION_MAX };

static int motions_of(int n)
{
  return n == 3 ? 6 : 3;
}

/* Give the displacements [n] of a node in the rigid motions of its body, motion by motion. */
static void find_motions(const dvi_elastic *e, const dvi__rigid_body *body, int64_t vertex,
                         double (*motion)[AXES])
{
  const int n = e->n;
  double r[AXES] = {0};
  memset(motion, 0, MOTIONS * sizeof *motion);
  for (int i = 0; i < n; i++) {
    r[i] = (e->point[vertex * n + i] - body->centre[i]) / body->size;
    motion[i][i] = 1;
  }
  for (int m = n; m < motions_of(n); m++) {
    const int axis = n == 3 ? m - n : 2, a = (axis + 1) % AXES, b = (axis + 2) % AXES;
    motion[m][a] = -r[b];
    motion[m][b] = r[a];
  }
}

/* ---- bodies ---- */

static dvi_status number_bodies(dvi__rigid *rigid)
{
  const dvi_elastic *e = rigid->elastic;
  int *root = DVI_NEW(int, e->vertices);
  rigid->body = DVI_NEW(int, e->vertices);
  if (root == NULL || rigid->body == NULL) {
    dvi__release(root);
    return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for bodies");
  }
  dvi__find_components(e->mesh, root);
  for (int64_t v = 0; v < e->vertices; v++)
    rigid->body[v] = root[v] == v ? (int)rigid->bodies++ : rigid->body[root[v]];
  dvi__release(root);
  rigid->of = DVI_NEW(dvi__rigid_body, rigid->bodies);
  rigid->sum = DVI_NEW(double, rigid->bodies *MOTIONS);
  return rigid->of != NULL && rigid->sum != NULL
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "elastic: no memory for %lld bodies",
                         (long long)rigid->bodies);
}

/* The sums hold the masses, and the size is half of the diagonal of the box of a body's nodes. */
static void measure_bodies(dvi__rigid *rigid)
{
  const dvi_elastic *e = rigid->elastic;
  const int n = e->n;
  for (int64_t v = 0; v < e->vertices; v++) {
    dvi__rigid_body *body = rigid->of + rigid->body[v];
    rigid->sum[rigid->body[v]] += e->mass[v];
    for (int i = 0; i < n; i++) body->centre[i] += e->mass[v] * e->point[v * n + i];
  }
  for (int64_t b = 0; b < rigid->bodies; b++)
    for (int i = 0; i < n; i++) rigid->of[b].centre[i] /= rigid->sum[b];
  for (int64_t v = 0; v < e->vertices; v++) {
    dvi__rigid_body *body = rigid->of + rigid->body[v];
    double distance = 0;
    for (int i = 0; i < n; i++) distance = hypot(distance, e->point[v * n + i] - body->centre[i]);
    body->size = fmax(body->size, distance);
  }
}

/* ---- motions ---- */

/* Products of motions [bodies][MOTIONS*MOTIONS], over all components and over those given. */
typedef struct products {
  double *all, *given;
} products;

static void sum_products(const dvi__rigid *rigid, products *sums)
{
  const dvi_elastic *e = rigid->elastic;
  const int n = e->n, motions = motions_of(n);
  for (int64_t v = 0; v < e->vertices; v++) {
    double motion[MOTIONS][AXES];
    const int64_t b = rigid->body[v];
    find_motions(e, rigid->of + b, v, motion);
    for (int r = 0; r < motions; r++)
      for (int s = 0; s < motions; s++)
        for (int i = 0; i < n; i++) {
          const double product = e->mass[v] * motion[r][i] * motion[s][i];
          const int64_t at = b * MOTIONS * MOTIONS + r * motions + s;
          sums->all[at] += product;
          if (e->unknown[v * n + i] < 0) sums->given[at] += product;
        }
  }
}

/* The share of a motion at the components that are given is an eigenvalue from 0 to 1 of the two
 * matrices of products. */
static dvi_status find_free(const dvi__rigid *rigid, const products *sums, int64_t b)
{
  const double roundoff = 1e-12;
  const int motions = motions_of(rigid->elastic->n);
  dvi__rigid_body *body = rigid->of + b;
  double share[MOTIONS], X[MOTIONS * MOTIONS];
  DVI_TRY(dvi__eigen_symmetric(motions, sums->given + b * MOTIONS * MOTIONS,
                               sums->all + b * MOTIONS * MOTIONS, share, X));
  for (int r = 0; r < motions && share[r] < roundoff; r++, body->count++)
    for (int s = 0; s < motions; s++) body->coefficient[r][s] = X[r * motions + s];
  return DVI_OK;
}

dvi_status dvi__rigid_create(const dvi_elastic *e, dvi__rigid *rigid)
{
  *rigid = (dvi__rigid){.elastic = e};
  DVI_TRY(number_bodies(rigid));
  measure_bodies(rigid);
  products sums = {.all = DVI_NEW(double, rigid->bodies *MOTIONS *MOTIONS),
                   .given = DVI_NEW(double, rigid->bodies *MOTIONS *MOTIONS)};
  dvi_status status = DVI_OK;
  if (sums.all != NULL && sums.given != NULL)
    sum_products(rigid, &sums);
  else
    status = dvi__fail(DVI_NO_MEMORY, "elastic: no memory for rigid motions");
  for (int64_t b = 0; b < rigid->bodies && status == DVI_OK; b++) {
    status = find_free(rigid, &sums, b);
    rigid->count += rigid->of[b].count;
  }
  dvi__release(sums.all);
  dvi__release(sums.given);
  return status;
}

void dvi__rigid_clear(dvi__rigid *rigid)
{
  dvi__release(rigid->body);
  dvi__release(rigid->of);
  dvi__release(rigid->sum);
  *rigid = (dvi__rigid){0};
}

/* Sum m x times the motions of each body. */
static void sum_up(const dvi__rigid *rigid, const double *x)
{
  const dvi_elastic *e = rigid->elastic;
  const int n = e->n, motions = motions_of(n);
  memset(rigid->sum, 0, (size_t)rigid->bodies * MOTIONS * sizeof *rigid->sum);
  for (int64_t v = 0; v < e->vertices; v++) {
    double motion[MOTIONS][AXES];
    find_motions(e, rigid->of + rigid->body[v], v, motion);
    for (int i = 0; i < n; i++) {
      const int k = e->unknown[v * n + i];
      for (int s = 0; s < motions && k >= 0; s++)
        rigid->sum[(int64_t)rigid->body[v] * MOTIONS + s] += e->mass[v] * motion[s][i] * x[k];
    }
  }
}

/* The part that a body has of its r-th motion. */
static double part_of(const dvi__rigid *rigid, int64_t b, int r)
{
  double product = 0;
  for (int s = 0; s < motions_of(rigid->elastic->n); s++)
    product += rigid->of[b].coefficient[r][s] * rigid->sum[b * MOTIONS + s];
  return product;
}

double dvi__rigid_share(const dvi__rigid *rigid, const double *x)
{
  double share = 0;
  sum_up(rigid, x);
  for (int64_t b = 0; b < rigid->bodies; b++)
    for (int r = 0; r < rigid->of[b].count; r++) {
      const double part = part_of(rigid, b, r);
      share += part * part;
    }
  return share;
}

void dvi__rigid_remove(const dvi__rigid *rigid, double *x)
{
  const dvi_elastic *e = rigid->elastic;
  const int n = e->n, motions = motions_of(n);
  sum_up(rigid, x);
  for (int64_t b = 0; b < rigid->bodies; b++) {
    double part[MOTIONS] = {0};
    for (int r = 0; r < rigid->of[b].count; r++)
      for (int s = 0; s < motions; s++)
        part[s] += part_of(rigid, b, r) * rigid->of[b].coefficient[r][s];
    memcpy(rigid->sum + b * MOTIONS, part, sizeof part);
  }
  for (int64_t v = 0; v < e->vertices; v++) {
    double motion[MOTIONS][AXES];
    find_motions(e, rigid->of + rigid->body[v], v, motion);
    for (int i = 0; i < n; i++)
      for (int s = 0; s < motions && e->unknown[v * n + i] >= 0; s++)
        x[e->unknown[v * n + i]] -= rigid->sum[(int64_t)rigid->body[v] * MOTIONS + s] *
                                    motion[s][i];
  }
}
