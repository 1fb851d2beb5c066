/* Contacts of the nodes of the boundary with obstacles. A node at x has the gap (x - point).normal
 * to a plane, |x - c| - R to a ball, and R - |x - c| in a hollow one. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic/contacts.h"
#include "field/elastic/system.h"

/* ---- the geometry of an obstacle ---- */

/* A node and an obstacle. */
typedef struct meeting {
  double x[DVI_ELASTIC_DIMENSION_MAX];    /* where the node is */
  double rate[DVI_ELASTIC_DIMENSION_MAX]; /* that of the conditions, 0 of the unknowns */
  double normal[DVI_ELASTIC_DIMENSION_MAX];
  double gap;
} meeting;

double dvi__solid_gap(const dvi_obstacle *o, int n, const double *x, double *normal)
{
  const double sign = o->kind == DVI_OBSTACLE_BALL ? 1 : -1;
  double distance = 0;
  if (o->kind == DVI_OBSTACLE_PLANE) {
    double gap = 0;
    for (int i = 0; i < n; i++) {
      gap += (x[i] - o->point[i]) * o->normal[i];
      normal[i] = o->normal[i];
    }
    return gap;
  }
  for (int i = 0; i < n; i++) distance = hypot(distance, x[i] - o->point[i]);
  for (int i = 0; i < n; i++)
    normal[i] = distance == 0 ? sign * (i == 0) : sign * (x[i] - o->point[i]) / distance;
  return sign * (distance - o->radius);
}

/* Returns as callbacks do. */
static int meet(const dvi__solid_contact *of, double t, const double *q, meeting *at)
{
  const dvi_elastic *e = of->elastic;
  *at = (meeting){.gap = 0};
  const int returned = dvi__solid_place(e, of->vertex, t, q, at->x, at->rate);
  for (int i = 0; i < e->n; i++) at->x[i] += e->point[of->vertex * e->n + i];
  at->gap = dvi__solid_gap(of->obstacle, e->n, at->x, at->normal);
  return returned;
}

/* Give n-1 unit vectors [n] at right angles to the normal and to each other. */
static void find_tangents(int n, const double *normal, double *tangent)
{
  if (n == 2) {
    tangent[0] = -normal[1], tangent[1] = normal[0];
    return;
  }
  int least = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(normal[i]) < fabs(normal[least])) least = i;
  const double length = sqrt(1 - normal[least] * normal[least]);
  for (int i = 0; i < 3; i++) tangent[i] = ((i == least) - normal[least] * normal[i]) / length;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    tangent[3 + i] = normal[j] * tangent[k] - normal[k] * tangent[j];
  }
}

/* ---- callbacks ---- */

static int gap(double t, const double *q, double *phi, void *user)
{
  meeting at;
  const int returned = meet(user, t, q, &at);
  *phi = at.gap;
  return returned;
}

/* Keep the entries of a vector [n] at the unknowns of the node. */
static void keep(const dvi__solid_contact *of, const double *vector, double *kept)
{
  const int n = of->elastic->n;
  for (int i = 0, k = 0; i < n; i++)
    if (of->elastic->unknown[of->vertex * n + i] >= 0) kept[k++] = vector[i];
}

static int gradient(double t, const double *q, double *phi_q, void *user)
{
  meeting at;
  const int returned = meet(user, t, q, &at);
  keep(user, at.normal, phi_q);
  return returned;
}

static int gap_rate(double t, const double *q, double *phi_t, void *user)
{
  const dvi__solid_contact *of = user;
  meeting at;
  const int returned = meet(of, t, q, &at);
  *phi_t = 0;
  for (int i = 0; i < of->elastic->n; i++) *phi_t += at.normal[i] * at.rate[i];
  return returned;
}

static int tangents(double t, const double *q, double *T, void *user)
{
  const dvi__solid_contact *of = user;
  const int n = of->elastic->n;
  meeting at;
  double tangent[DVI_ELASTIC_DIMENSION_MAX * DVI_ELASTIC_DIMENSION_MAX];
  const int returned = meet(of, t, q, &at);
  find_tangents(n, at.normal, tangent);
  for (int a = 0; a < n - 1; a++) keep(of, tangent + a * n, T + a * of->count);
  return returned;
}

/* ---- terms ---- */

static void set_contact(dvi__solid_system *s, int64_t vertex, const dvi_obstacle *obstacle)
{
  const dvi_elastic *e = s->elastic;
  dvi__solid_contact *of = s->contact + s->contacts;
  *of = (dvi__solid_contact){.elastic = e, .obstacle = obstacle, .vertex = vertex};
  int is_driven = 0;
  for (int i = 0; i < e->n; i++) {
    if (e->unknown[vertex * e->n + i] >= 0) of->row[of->count++] = e->unknown[vertex * e->n + i];
    is_driven |= dvi__solid_is_driven(e, vertex * e->n + i);
  }
  for (int a = 1; a < e->n; a++) {
    of->start[a] = a * of->count;
    for (int k = 0; k < of->count; k++) of->row[a * of->count + k] = of->row[k];
  }
  (void)snprintf(of->name, sizeof of->name, "%.60s at vertex %lld", obstacle->name,
                 (long long)vertex);
  const dvi_pattern pattern = {.start = of->start, .row = of->row};
  const int rubs = obstacle->friction > 0;
  s->contact_term[s->contacts++] = (dvi_contact){.name = of->name,
                                                 .gap = gap,
                                                 .gradient = gradient,
                                                 .rate = is_driven ? gap_rate : NULL,
                                                 .gradients = pattern,
                                                 .restitution = obstacle->restitution,
                                                 .friction = obstacle->friction,
                                                 .tangent = rubs ? tangents : NULL,
                                                 .tangent_count = rubs ? e->n - 1 : 0,
                                                 .tangents = pattern,
                                                 .user = of};
}

/* Nodes do not hit where the displacements on which a gap depends are all given. */
static int can_hit(const dvi_elastic *e, int64_t vertex, const dvi_obstacle *o)
{
  int can = 0;
  for (int i = 0; i < e->n; i++)
    can |= e->unknown[vertex * e->n + i] >= 0 &&
           (o->kind != DVI_OBSTACLE_PLANE || o->normal[i] != 0);
  return e->is_outer[vertex] && can;
}

dvi_status dvi__solid_make_contacts(dvi__solid_system *s)
{
  const dvi_elastic *e = s->elastic;
  int64_t contacts = 0;
  if (e->obstacles == 0) return DVI_OK;
  for (int o = 0; o < e->obstacles; o++)
    for (int64_t v = 0; v < e->vertices; v++) contacts += can_hit(e, v, e->obstacle + o);
  s->contact = DVI_NEW(dvi__solid_contact, contacts);
  s->contact_term = DVI_NEW(dvi_contact, contacts);
  if (s->contact == NULL || s->contact_term == NULL)
    return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for %lld contacts", (long long)contacts);
  for (int o = 0; o < e->obstacles; o++)
    for (int64_t v = 0; v < e->vertices; v++)
      if (can_hit(e, v, e->obstacle + o)) set_contact(s, v, e->obstacle + o);
  return DVI_OK;
}
