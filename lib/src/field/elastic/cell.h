/* What a cell stores and pulls, beside what elastic.h tells. */
#ifndef DVI_FIELD_ELASTIC_CELL_H
#define DVI_FIELD_ELASTIC_CELL_H
#include "field/elastic/laws.h"
#include "field/mesh/mesh.h"

/* Give H = grad u of displacements u [(n+1)*n], with the gradients g [n*n] of the barycentric
 * coordinates but the first one. n is a constant where this is called. */
static inline void dvi__displacement_gradient(int n, const double *g, const double *u, double *H)
{
  for (int i = 0; i < n; i++) {
    double difference[DVI_ELASTIC_DIMENSION_MAX];
    for (int a = 0; a < n; a++) difference[a] = u[(a + 1) * n + i] - u[i];
    for (int j = 0; j < n; j++) {
      double sum = 0;
      for (int a = 0; a < n; a++) sum += difference[a] * g[a * n + j];
      H[i * n + j] = sum;
    }
  }
}

/* The gradients of a cell's barycentric coordinates but the first one. */
static inline const double *dvi__solid_gradients(const dvi_elastic *e, int64_t cell)
{
  return e->gradient + (cell * (e->n + 1) + 1) * e->n;
}

/* Give the forces of a cell of a material, a volume, and gradients [n*n] as above. Returns as
 * dvi__solid_force. */
int dvi__solid_force_of(int n, const dvi__solid_material *m, double volume, const double *g,
                        const double *u, double *f);

enum { DVI__SOLID_BATCH = 32 };

/* Give the forces [count][(n+1)*n] of `count` cells from `first` on, at most DVI__SOLID_BATCH, at
 * displacements u [count][(n+1)*n] of their nodes. Energies that are given are called once for
 * cells in a row. Returns as dvi__solid_force, and in *failed the place of the cell of which. */
int dvi__solid_forces(const dvi_elastic *e, int64_t first, int count, const double *u, double *f,
                      int *failed);

/* Give the forces f [(n+1)*n] of the stiffness at rest. */
void dvi__solid_rest_force(const dvi_elastic *e, int64_t cell, const double *u, double *f);

/* Give H of a cell. */
void dvi__solid_strain(const dvi_elastic *e, int64_t cell, const double *u, double *H);

/* Write the sentence about a condition for which dvi__solid_given returned not 0. */
dvi_status dvi__solid_refuse_given(const dvi_elastic *e, int64_t vertex, int returned);

#endif
