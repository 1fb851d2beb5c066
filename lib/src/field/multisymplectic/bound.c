/* The largest stable step.
 *
 * Of quadratic densities with the mass M and the stiffness K of the weights in space, an eigenvalue
 * lambda of K x = lambda M x moves by 4 sin^2(th/2) = dt^2 lambda (1 - 4 a sin^2(th/2)) with the
 * weight a of time. The angle th is real as long as dt^2 lambda <= 4/(1 - 4 a). The largest lambda
 * of one cell bounds that of the lattice (Irons and Treharne 1971). For constant coefficients it is
 * sum_d 4 c^2/dx_d^2/(1 - 4 a_d), which the values that alternate along all axes have. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/random.h"
#include "field/multisymplectic/lattice.h"
#include "num/eigen.h"

/* Matrices of a cell [n*n], and those of the cell before. */
typedef struct cell_matrices {
  int n;
  double *K, *M, *before, *lambda, *X;
  double *kinetic; /* [points][components*components] */
  int64_t *taken;  /* [conditions] points of fluxes in the cells before */
  double largest;
} cell_matrices;

static dvi_status allocate(const dvi__lattice *lattice, cell_matrices *m)
{
  const size_t n = (size_t)lattice->corners * (size_t)lattice->components,
               components = (size_t)lattice->components;
  m->n = (int)n;
  m->K = DVI_NEW(double, 2 * n * n);
  m->before = DVI_NEW(double, 2 * n * n);
  m->lambda = DVI_NEW(double, n);
  m->X = DVI_NEW(double, n *n);
  m->kinetic = DVI_NEW(double, (size_t)lattice->points *components *components);
  m->taken = DVI_NEW(int64_t, (size_t)lattice->conditions + 1);
  if (!m->K || !m->before || !m->lambda || !m->X || !m->kinetic || !m->taken)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for matrices of cells");
  m->M = m->K + n * n;
  return DVI_OK;
}

static void clear(cell_matrices *m)
{
  dvi__release(m->K);
  dvi__release(m->before);
  dvi__release(m->lambda);
  dvi__release(m->X);
  dvi__release(m->kinetic);
  dvi__release(m->taken);
}

/* Whether the rates enter by a constant matrix. */
static int has_constant_mass(const dvi__lattice *lattice)
{
  for (int i = 0; i < lattice->parts; i++) {
    const dvi__lattice_part *part = &lattice->part[i];
    for (int p = 0; p < part->pairs; p++)
      if (part->varies[p] && part->variable[part->pair[p][0]].is_rate &&
          part->variable[part->pair[p][1]].is_rate)
        return 0;
  }
  return 1;
}

/* ---- a cell ---- */

/* Add w l_ab of a point to the kinetic matrix there, and with the functions of corners to M or -K.
 * `scale` is 1 over the widths of derivatives. */
static void add_point(const dvi__batch *b, int q, const dvi__lattice_variable *row,
                      const dvi__lattice_variable *column, double l_ab, cell_matrices *m)
{
  const dvi__lattice *lattice = b->lattice;
  const int corners = lattice->corners, components = lattice->components;
  double *to = row->is_rate ? m->M : m->K;
  const double weight = row->is_rate ? b->weight[q] : -b->weight[q];
  if (row->is_rate)
    m->kinetic[(q * components + column->component) * components + row->component] += l_ab;
  for (int i = 0; i < corners; i++)
    for (int j = 0; j < corners; j++)
      to[(column->component * corners + j) * m->n + row->component * corners + i] +=
          weight * l_ab * lattice->shape[1 + row->axis][q][i] *
          lattice->shape[1 + column->axis][q][j];
}

/* Add a part's constant second derivatives, but not those that mix rates with other variables. */
static dvi_status add_part(const dvi__lattice *lattice, const dvi__lattice_part *part, int64_t cell,
                           cell_matrices *m)
{
  dvi__batch b = dvi__batch_begin(lattice, part, cell, 1);
  (void)dvi__fill_random((int64_t)part->variables * b.count, 1, b.z);
  DVI_TRY(dvi__batch_evaluate(&b, DVI__WANT_L_ZZ));
  for (int p = 0; p < part->pairs; p++) {
    const dvi__lattice_variable *row = &part->variable[part->pair[p][0]],
                                *column = &part->variable[part->pair[p][1]];
    const double widths = dvi__batch_width(&b, row, 0) * dvi__batch_width(&b, column, 0);
    if (part->varies[p] || row->is_rate != column->is_rate) continue;
    for (int q = 0; q < b.count; q++) {
      const double l_ab = b.l_zz[p * b.count + q] / widths;
      add_point(&b, q, row, column, l_ab, m);
      if (row != column) add_point(&b, q, column, row, l_ab, m);
    }
  }
  return DVI_OK;
}

static int all_vary(const dvi__lattice_part *part)
{
  for (int p = 0; p < part->pairs; p++)
    if (!part->varies[p]) return 0;
  return 1;
}

static dvi_status check_kinetic(const dvi__lattice *lattice, int64_t cell, cell_matrices *m)
{
  const int components = lattice->components;
  for (int q = 0; q < lattice->points; q++)
    if (!dvi__is_positive_definite(components, m->kinetic + q * components * components))
      return dvi__fail(DVI_SINGULAR,
                       "multisymplectic: the density is not positive definite in the rates of the "
                       "field in cell %lld; each component needs a kinetic part",
                       (long long)cell);
  return DVI_OK;
}

static dvi_status look_at_cell(const dvi__lattice *lattice, int64_t cell, cell_matrices *m)
{
  const size_t n = (size_t)m->n, components = (size_t)lattice->components,
               both = 2 * n * n * sizeof *m->K;
  memset(m->K, 0, both);
  memset(m->kinetic, 0, (size_t)lattice->points * components * components * sizeof *m->kinetic);
  for (int i = 0; i < lattice->parts; i++)
    if (!all_vary(&lattice->part[i])) DVI_TRY(add_part(lattice, &lattice->part[i], cell, m));
  dvi__lattice_add_fluxes_of_cell(lattice, cell, m->taken, m->K);
  if (cell > 0 && memcmp(m->K, m->before, both) == 0) return DVI_OK;
  memcpy(m->before, m->K, both);
  DVI_TRY(check_kinetic(lattice, cell, m));
  if (lattice->time_weight >= 0.25) return DVI_OK;
  DVI_TRY(dvi__eigen_symmetric(m->n, m->K, m->M, m->lambda, m->X));
  m->largest = fmax(m->largest, m->lambda[m->n - 1]);
  return DVI_OK;
}

dvi_status dvi__lattice_find_bound(dvi__lattice *lattice)
{
  cell_matrices m = {0};
  lattice->bound = HUGE_VAL;
  if (!has_constant_mass(lattice)) return DVI_OK;
  dvi_status status = allocate(lattice, &m);
  for (int64_t cell = 0; cell < lattice->cells && status == DVI_OK; cell++)
    status = look_at_cell(lattice, cell, &m);
  if (m.largest > 0) lattice->bound = 2 / sqrt((1 - 4 * lattice->time_weight) * m.largest);
  clear(&m);
  return status;
}
