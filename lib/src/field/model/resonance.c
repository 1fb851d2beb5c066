/* Modes of forms of degree 1, K x = lambda M x, without those of frequency zero.
 *
 * K = d^T M_2 d vanishes on the gradients d phi of functions that are zero where the form is held.
 * Nothing separates their eigenvalue 0, of a multiplicity like the number of vertices, from the
 * lowest ones that are wanted. But it is known what they are: Lanczos' method for the inverse of
 * K + s M stays among the forms without charge, d^T M x = 0, if all vectors are projected onto
 * them, which takes the solution of one Poisson equation. What is left with eigenvalue zero are
 * harmonic forms: a few, by topology.
 *
 * Conjugate gradients for K + s M are slow on gradients, whose eigenvalue s is far below the others
 * on the scale of the mesh. Their preconditioner treats gradients apart (Hiptmair 1998). */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/definite.h"
#include "field/forms/star.h"
#include "field/mesh/connected.h"
#include "field/mesh/homology.h"
#include "field/model/spectrum.h"

/* All modes are found at once up to this size. */
enum { MOST_FULL = 500 };
/* Part of the size of the lowest eigenvalues that can be zero beside a shift, near which harmonic
 * forms need not lie, and part of the largest one that roundings of full matrices leave. */
static const double zero_of_lowest = 1e-6, rounding = 1e-15;

typedef struct resonance {
  const dvi_field *field;
  dvi_matrix K, M;
  int64_t gradients;     /* columns of d */
  dvi__csr d, Md;        /* [unknowns, gradients] */
  dvi__definite poisson; /* of d^T M d */
  double *charge, *phi;  /* [gradients] each */
  double *value, *vector;
  int64_t zeros; /* dimension of the kernel of K */
} resonance;

static void clear(resonance *r)
{
  dvi__csr_clear(&r->d);
  dvi__csr_clear(&r->Md);
  dvi__definite_clear(&r->poisson);
  dvi__release(r->charge);
  dvi__release(r->value);
}

/* ---- gradients ---- */

/* Number the vertices whose functions have independent gradients that vanish where the form is
 * held: those that are on no held edge, but one of each component that has none. */
static int64_t number_vertices(const dvi_field *f, int *number, int *root, char *is_held)
{
  const dvi_mesh *mesh = f->mesh;
  int64_t count = 0;
  dvi__find_components(mesh, root);
  for (int64_t e = 0; e < mesh->count[1]; e++)
    for (int c = 0; c < 2 && f->number[e] < 0; c++) number[mesh->corner[1][2 * e + c]] = -1;
  for (int64_t v = 0; v < mesh->count[0]; v++)
    if (number[v] < 0) is_held[root[v]] = 1;
  for (int64_t v = 0; v < mesh->count[0]; v++)
    if (number[v] == 0) number[v] = root[v] == v && !is_held[v] ? -1 : (int)count++;
  return count;
}

static dvi_status make_gradients(resonance *r)
{
  const dvi_field *f = r->field;
  const int64_t vertices = f->mesh->count[0];
  dvi_matrix d;
  int *number = DVI_NEW(int, 2 * vertices);
  char *is_held = DVI_NEW(char, vertices);
  dvi_status status = number != NULL && is_held != NULL
                          ? dvi_mesh_incidence(f->mesh, 0, &d)
                          : dvi__fail(DVI_NO_MEMORY, "modes: no memory for gradients");
  if (status == DVI_OK) {
    r->gradients = number_vertices(f, number, number + vertices, is_held);
    const dvi__selection part = {
        .row = f->number, .column = number, .rows = f->unknowns, .columns = r->gradients};
    status = dvi__csr_select(&d, &part, &r->d);
  }
  dvi__release(number);
  dvi__release(is_held);
  return status;
}

/* Make M d and the matrix d^T M d of Poisson's equation. */
static dvi_status prepare_projection(resonance *r)
{
  const dvi_matrix d = dvi__csr_view(&r->d, 0);
  dvi__csr matrix = {0};
  r->charge = DVI_NEW(double, 2 * r->gradients);
  if (r->charge == NULL) return dvi__fail(DVI_NO_MEMORY, "modes: no memory for gradients");
  r->phi = r->charge + r->gradients;
  dvi_status status = dvi__csr_product(&r->M, &d, &r->Md);
  const dvi_matrix right = dvi__csr_view(&r->Md, 0);
  if (status == DVI_OK) status = dvi__csr_transposed_product(&d, &right, &matrix);
  const dvi_matrix square = dvi__csr_view(&matrix, 1);
  if (status == DVI_OK) status = dvi__definite_create(&square, r->field->mesh->n, &r->poisson);
  dvi__csr_clear(&matrix);
  return status;
}

/* Take the gradient part away, x - d phi with d^T M d phi = d^T M x. */
static dvi_status project(void *of, double *x)
{
  resonance *r = of;
  const dvi_matrix Md = dvi__csr_view(&r->Md, 0);
  dvi_matrix_multiply(&Md, 1, x, r->charge);
  DVI_TRY(dvi__definite_solve(&r->poisson, r->charge, r->phi, NULL));
  for (int64_t i = 0; i < r->d.rows; i++)
    for (int64_t e = r->d.start[i]; e < r->d.start[i + 1]; e++)
      x[i] -= r->d.value[e] * r->phi[r->d.column[e]];
  return DVI_OK;
}

/* Add the part of a preconditioner of K + s M that is made of gradients, d (s d^T M d)^-1 d^T r. */
static void add_gradients(void *of, double s, const double *residual, double *z)
{
  const resonance *r = of;
  const dvi_matrix d = dvi__csr_view(&r->d, 0), G = dvi__csr_view(&r->poisson.matrix, 1);
  dvi_matrix_multiply(&d, 1, residual, r->charge);
  dvi__gauss_seidel(&G, r->charge, r->phi);
  for (int64_t i = 0; i < d.rows; i++)
    for (int64_t e = d.start[i]; e < d.start[i + 1]; e++)
      z[i] += d.value[e] * r->phi[d.column[e]] / s;
}

/* ---- modes ---- */

/* The kernel of K is that of d_1 on the forms that are free: its dimension is exact. */
static dvi_status count_zeros(resonance *r)
{
  const dvi_field *f = r->field;
  int64_t rank;
  char *held = DVI_NEW(char, f->cells);
  if (held == NULL) return dvi__fail(DVI_NO_MEMORY, "modes: no memory for ranks");
  for (int64_t e = 0; e < f->cells; e++) held[e] = f->number[e] < 0;
  const dvi_status status = dvi__incidence_rank(f->mesh, 1, held, &rank);
  dvi__release(held);
  if (status == DVI_OK) r->zeros = f->unknowns - rank;
  return status;
}

/* Move the modes that are not zero, of ascending values, to the front: at most `zeros` of values up
 * to `most` are. Returns their number. */
static int drop_zeros(resonance *r, int found, int64_t zeros, double most)
{
  const size_t n = (size_t)r->field->unknowns;
  const int count = zeros < found ? (int)zeros : found,
            first = dvi__first_of_nearest(found, r->value, count, 0);
  int kept = 0;
  for (int i = 0; i < found; i++) {
    if (i >= first && i < first + count && fabs(r->value[i]) <= most) continue;
    r->value[kept] = r->value[i];
    if (kept != i)
      memcpy(r->vector + (size_t)kept * n, r->vector + (size_t)i * n, n * sizeof(double));
    kept++;
  }
  return kept;
}

static dvi_status reserve(resonance *r, int64_t count)
{
  const int64_t n = r->field->unknowns;
  dvi__release(r->value);
  r->value = DVI_NEW(double, count + count * n);
  if (r->value == NULL)
    return dvi__fail(DVI_NO_MEMORY, "modes: no memory for %lld vectors of %lld numbers",
                     (long long)count, (long long)n);
  r->vector = r->value + count;
  return DVI_OK;
}

/* Find all modes of a small field. */
static dvi_status find_all(resonance *r, int *found)
{
  const int n = (int)r->field->unknowns;
  const dvi__pencil pencil = {.K = &r->K, .M = &r->M, .dimension = r->field->mesh->n};
  DVI_TRY(reserve(r, n));
  DVI_TRY(dvi__modes_near(&pencil, 0, n, r->value, r->vector));
  const double largest = r->value[n - 1];
  *found = drop_zeros(r, n, r->zeros, INFINITY);
  for (int i = 0; i < *found; i++)
    if (fabs(r->value[i]) < rounding * largest)
      return dvi__fail(DVI_SINGULAR,
                       "modes: roundings of full matrices hide the eigenvalue %g, because others "
                       "reach %g: refine the mesh to more than %d unknowns, or bring the materials "
                       "nearer to each other",
                       r->value[i], largest, MOST_FULL);
  return DVI_OK;
}

/* Find the nearest ones to a shift, with as many more as there are harmonic forms. */
static dvi_status find_nearest(resonance *r, double shift, int count, int *found)
{
  const dvi_field *f = r->field;
  const double below = dvi__shift_below_zero(f), from = shift != 0 ? shift : below;
  DVI_TRY(make_gradients(r));
  if (r->gradients > 0) DVI_TRY(prepare_projection(r));
  const dvi__pencil pencil = {.K = &r->K,
                              .M = &r->M,
                              .dimension = f->mesh->n,
                              .project = r->gradients > 0 ? project : NULL,
                              .add_kernel = r->gradients > 0 ? add_gradients : NULL,
                              .of = r};
  const int64_t harmonic = r->zeros - r->gradients, asked = count + harmonic;
  if (count < 1 || asked + r->gradients >= f->unknowns)
    return dvi__fail(DVI_BAD_SIZE,
                     "field: %d modes of %lld unknowns, of which %lld are static: "
                     "take 1 to %lld",
                     count, (long long)f->unknowns, (long long)r->zeros,
                     (long long)(f->unknowns - r->zeros - 1));
  DVI_TRY(reserve(r, asked));
  DVI_TRY(dvi__modes_near(&pencil, from, (int)asked, r->value, r->vector));
  *found = drop_zeros(r, (int)asked, harmonic,
                      shift != 0 ? zero_of_lowest * fabs(below) : (double)INFINITY);
  return DVI_OK;
}

static dvi_status find(resonance *r, double shift, int count, double *eigenvalue, double *mode)
{
  const dvi_field *f = r->field;
  int found = 0;
  DVI_TRY(count_zeros(r));
  DVI_TRY(f->unknowns <= MOST_FULL ? find_all(r, &found) : find_nearest(r, shift, count, &found));
  if (count < 1 || count > found)
    return dvi__fail(DVI_BAD_SIZE,
                     "field: %d modes of %lld unknowns, of which %lld are static: "
                     "take 1 to %d",
                     count, (long long)f->unknowns, (long long)r->zeros, found);
  const int first = dvi__first_of_nearest(found, r->value, count, fmax(shift, 0));
  memcpy(eigenvalue, r->value + first, (size_t)count * sizeof *eigenvalue);
  dvi__spread_modes(f, count, r->vector + (int64_t)first * f->unknowns, mode);
  return DVI_OK;
}

dvi_status dvi__field_modes_of_form(const dvi_field *field, const dvi_modes_options *options,
                                    double *eigenvalue, double *mode, int64_t *zeros)
{
  resonance r = {.field = field};
  const int count = options->count != 0 ? options->count : 6;
  if (!isfinite(options->shift))
    return dvi__fail(DVI_BAD_ARGUMENT, "modes: the shift is %g", options->shift);
  DVI_TRY(dvi_field_matrix(field, DVI_FIELD_STIFFNESS, &r.K));
  DVI_TRY(dvi_field_matrix(field, DVI_FIELD_MASS, &r.M));
  const dvi_status status = find(&r, options->shift, count, eigenvalue, mode);
  if (status == DVI_OK && zeros != NULL) *zeros = r.zeros;
  clear(&r);
  return status;
}
