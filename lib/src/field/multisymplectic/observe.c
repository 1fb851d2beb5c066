/* Energy, momenta, and what belongs to symmetries. */
#include <math.h>
#include <stdio.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multisymplectic/march.h"

enum { FIXED = 1 };

static int count_periodic(const dvi__lattice *lattice)
{
  int count = 0;
  for (int d = 0; d < lattice->axes; d++) count += lattice->axis[d].is_periodic;
  return count;
}

/* Give the periodic axis with a number. */
static int periodic_axis(const dvi__lattice *lattice, int number)
{
  int d = 0;
  while (!lattice->axis[d].is_periodic || number-- > 0) d++;
  return d;
}

int dvi__lattice_observables(const void *self)
{
  const dvi__lattice *lattice = &((const dvi__lattice_march *)self)->lattice;
  return FIXED + count_periodic(lattice) + lattice->symmetries;
}

const char *dvi__lattice_observable(const void *self, int i)
{
  const dvi__lattice *lattice = &((const dvi__lattice_march *)self)->lattice;
  const int momenta = count_periodic(lattice);
  if (i < FIXED) return "energy";
  if (i < FIXED + momenta) return lattice->axis[periodic_axis(lattice, i - FIXED)].momentum;
  return lattice->symmetry[i - FIXED - momenta].name;
}

/* -sum p D u with the central difference D, which commutes with translations. */
static double momentum(const dvi__lattice_march *m, int d)
{
  const dvi__lattice *lattice = &m->lattice;
  const dvi__lattice_axis *a = &lattice->axis[d];
  int64_t stride = 1;
  double sum = 0;
  for (int e = d + 1; e < lattice->axes; e++) stride *= lattice->axis[e].vertices;
  for (int64_t i = 0; i < lattice->size; i++) {
    const int at = (int)(i / stride % a->cells), last = a->cells - 1;
    const int64_t up = i + (at < last ? 1 : -last) * stride,
                  down = i - (at > 0 ? 1 : -last) * stride;
    const double above = a->node[at + 1] - a->node[at],
                 below = at > 0 ? a->node[at] - a->node[at - 1] : a->node[a->cells] - a->node[last];
    sum -= m->p_now[i] * (m->now[up] - m->now[down]) / (above + below);
  }
  return sum;
}

static dvi_status noether(const dvi__lattice_march *m, const dvi_multisymplectic_symmetry *symmetry,
                          double *found)
{
  const dvi__lattice *lattice = &m->lattice;
  double *xi = DVI_NEW(double, lattice->size), sum = 0;
  dvi_status status = DVI_OK;
  if (xi == NULL) return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for a symmetry");
  const int failed = symmetry->field(lattice->vertices, m->now, xi, symmetry->user);
  if (failed != 0)
    status = dvi__fail(failed > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                       "multisymplectic: the symmetry %s failed with %d", symmetry->name, failed);
  for (int64_t i = 0; i < lattice->size; i++) sum += m->p_now[i] * xi[i];
  if (status == DVI_OK && !isfinite(sum))
    status = dvi__fail(DVI_NOT_FINITE, "multisymplectic: the symmetry %s gives %g", symmetry->name,
                       sum);
  if (status == DVI_OK) *found = sum;
  dvi__release(xi);
  return status;
}

dvi_status dvi__lattice_observe(const void *self, int i, double *found)
{
  const dvi__lattice_march *m = self;
  const int momenta = count_periodic(&m->lattice);
  const dvi__row row = {.t = m->t0 + (double)m->step * m->lattice.dt, .u = {m->now, m->next}};
  if (i < FIXED) return dvi__row_energy(&m->lattice, &row, found);
  if (i >= FIXED + momenta) return noether(m, &m->lattice.symmetry[i - FIXED - momenta], found);
  *found = momentum(m, periodic_axis(&m->lattice, i - FIXED));
  return DVI_OK;
}
