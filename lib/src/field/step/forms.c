/* The strains of a k-form: B = dA on the (k+1)-cells, which know nothing of static potentials. */
#include <math.h>
#include <string.h>

#include "field/step/growth.h"

/* Give B on a (k+1)-cell. */
static double field_of(const dvi__flow *flow, int64_t face)
{
  const int *code = flow->facet + face * flow->width;
  double sum = flow->bias[face];
  for (int c = 0; c < flow->width; c++) {
    const int i = dvi__flow_number(code[c]);
    if (i < flow->n) sum += code[c] < 0 ? -flow->A[i] : flow->A[i];
  }
  return sum;
}

/* d^T M_{k+1} d */
static void stiffness(const dvi__flow *flow, double *K)
{
  const size_t n = (size_t)flow->n;
  for (int64_t f = 0; f < flow->strains; f++)
    for (int a = 0; a < flow->width; a++)
      for (int b = 0; b < flow->width; b++) {
        const int i = flow->facet[f * flow->width + a], j = flow->facet[f * flow->width + b];
        const size_t row = (size_t)dvi__flow_number(i), column = (size_t)dvi__flow_number(j);
        if (row < n && column < n)
          K[column * n + row] += (i < 0) == (j < 0) ? flow->M2[f] : -flow->M2[f];
      }
}

/* Add d^T h to a vector of the edges. */
static void add_transposed(const dvi__flow *flow, const double *h, double *x)
{
  for (int64_t i = 0; i < flow->strains * flow->width; i++) {
    const int code = flow->facet[i], e = dvi__flow_number(code);
    if (e < flow->n) x[e] += code < 0 ? -h[i / flow->width] : h[i / flow->width];
  }
}

/* D = d^T h and A = M1^-1 d^T h with random h are M1-orthogonal to all fields of zero curl. */
static void scatter(const dvi__flow *flow)
{
  double *const parts[] = {flow->A, flow->D}, *h = flow->work;
  double energy = 0;
  for (int k = 0; k < 2; k++) {
    memset(parts[k], 0, (size_t)flow->n * sizeof(double));
    for (int64_t f = 0; f < flow->strains; f++)
      h[f] = sqrt(flow->M2[f]) * dvi__random_between((uint64_t)(2 * f + k));
    add_transposed(flow, h, parts[k]);
  }
  const double per_A = 0.5 * flow->bound;
  for (int64_t e = 0; e < flow->n; e++) {
    energy += flow->D[e] * flow->D[e] * flow->inverse[e];
    flow->A[e] *= flow->inverse[e] * per_A;
  }
  for (int64_t f = 0; f < flow->strains; f++) {
    const double B = field_of(flow, f);
    energy += B * B * flow->M2[f];
  }
  for (int64_t e = 0; e < flow->n; e++) {
    flow->A[e] /= sqrt(energy);
    flow->D[e] /= sqrt(energy);
  }
}

/* B = bias + dA, from A = 0 on. */
static void put(const dvi__flow *flow, const double *strain)
{
  memset(flow->A, 0, (size_t)flow->n * sizeof(double));
  memcpy(flow->bias, strain, (size_t)flow->strains * sizeof(double));
}

static void take(const dvi__flow *flow, double *strain)
{
  for (int64_t f = 0; f < flow->strains; f++) strain[f] = field_of(flow, f);
  memset(flow->bias, 0, (size_t)flow->strains * sizeof(double));
}

static void weigh(const dvi__flow *flow, const double *strain, double *image)
{
  for (int64_t f = 0; f < flow->strains; f++) image[f] = flow->M2[f] * strain[f];
}

const dvi__flow_strain dvi__strain_of_forms = {
    .stiffness = stiffness, .scatter = scatter, .put = put, .take = take, .weigh = weigh};
