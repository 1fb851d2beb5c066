/* Matrices of the unknowns, assembled from those of cells. */
#ifndef DVI_FIELD_ELASTIC_ASSEMBLE_H
#define DVI_FIELD_ELASTIC_ASSEMBLE_H
#include "field/elastic/cell.h"

/* Where the numbers of cells stand in a matrix. Rows of one node have the same columns, and the
 * columns of a node stand in a row. */
typedef struct dvi__solid_pattern {
  dvi__csr matrix; /* with zeros, symmetric */
  int *place;      /* [cells*(n+1)^2] of node a and b: where the columns of b begin in a row of a */
} dvi__solid_pattern;

/* Find the pattern. On failure nothing is owned. */
dvi_status dvi__solid_pattern_create(const dvi_elastic *e, dvi__solid_pattern *pattern);
void dvi__solid_pattern_clear(dvi__solid_pattern *pattern);

/* Find the pattern, with the stiffness at rest in its matrix. */
dvi_status dvi__solid_rest_pattern(const dvi_elastic *e, dvi__solid_pattern *pattern);

/* Add a matrix of a cell [((n+1)*n)^2] to values in the order of the pattern. */
void dvi__solid_add_matrix(const dvi_elastic *e, const dvi__solid_pattern *pattern, int64_t cell,
                           const double *K, double *value);

/* Give displacements [(n+1)*n] of a cell's nodes at coordinates q and time t. Returns 0, or a
 * negative number of a condition. */
int dvi__solid_gather_unknowns(const dvi_elastic *e, int64_t cell, double t, const double *q,
                               double *u);

/* Give the rates [(n+1)*n] of the nodes of a cell that conditions move, and 0 for the others.
 * Returns whether there are any, or a negative number of a callback. */
int dvi__solid_driven_rates(const dvi_elastic *e, int64_t cell, double t, double *rate);

/* Add numbers of a cell's nodes [(n+1)*n] to those of the unknowns. */
static inline void dvi__solid_scatter(const dvi_elastic *e, int64_t cell, const double *own,
                                      double *all)
{
  const int n = e->n, *vertex = e->vertex + cell * (n + 1);
  for (int a = 0; a <= n; a++)
    for (int i = 0; i < n; i++) {
      const int k = e->unknown[(int64_t)vertex[a] * n + i];
      if (k >= 0) all[k] += own[a * n + i];
    }
}

/* Tell if a component of a vertex moves as a condition says. */
static inline int dvi__solid_is_driven(const dvi_elastic *e, int64_t component)
{
  const int c = e->condition[component];
  return c >= 0 && e->conditions[c].displacement != NULL && !e->conditions[c].is_steady;
}

/* Tell if a component of it does. */
static inline int dvi__solid_node_is_driven(const dvi_elastic *e, int64_t vertex)
{
  int is_driven = 0;
  for (int i = 0; i < e->n && e->is_driven; i++)
    is_driven |= dvi__solid_is_driven(e, vertex * e->n + i);
  return is_driven;
}

/* Give the displacement of a node at coordinates q, NULL for 0, and time t, and its given rates,
 * which stay where they are unknown or 0. `rate` may be NULL. Returns as dvi__solid_given. */
static inline int dvi__solid_place(const dvi_elastic *e, int64_t vertex, double t, const double *q,
                                   double *u, double *rate)
{
  for (int i = 0; i < e->n; i++) {
    const int64_t component = vertex * e->n + i;
    const int k = e->unknown[component];
    u[i] = k < 0 ? e->steady[component] : q != NULL ? q[k] : 0;
  }
  return dvi__solid_node_is_driven(e, vertex) ? dvi__solid_given(e, vertex, t, u, rate) : 0;
}

#endif
