/* Modes of a field, K x = lambda M x, and its fastest frequency. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "field/model/spectrum.h"
#include "field/pencil/on_share.h"

/* With free components K is semidefinite. A shift below 0, of the size of the lowest eigenvalues,
 * makes it definite: an entry of the diagonal of K over that of M is about 4 n/h^2, and a length of
 * the mesh about h N^(1/n). */
double dvi__shift_below_zero(const dvi_field *f)
{
  double k = 0, m = 0;
  for (int64_t i = 0; i < f->unknowns; i++) {
    k += f->stiffness.value[dvi__csr_find(&f->stiffness, i, (int)i)];
    m += f->mass.value[dvi__csr_find(&f->mass, i, (int)i)];
  }
  return -0.1 * k / m * pow((double)f->unknowns, -2.0 / f->mesh->n);
}

void dvi__spread_modes(const dvi_field *field, int count, const double *vector, double *mode)
{
  const int64_t cells = field->cells;
  for (int i = 0; i < count && mode != NULL; i++)
    for (int64_t c = 0; c < cells; c++)
      mode[i * cells + c] = field->number[c] >= 0 ? vector[i * field->unknowns + field->number[c]]
                                                  : 0;
}

typedef struct spectrum {
  const dvi_field *field;
  dvi__pencil pencil;
  int count, asked;
  double *value, *vector; /* [asked], [asked][unknowns] */
  double *one, *weight;   /* [unknowns] the sums of M's rows; [components] their sums */
} spectrum;

/* ---- zero modes ---- */

static void weigh_components(spectrum *s)
{
  const dvi_field *f = s->field;
  double *ones = s->vector; /* not in use yet */
  for (int64_t i = 0; i < f->unknowns; i++) ones[i] = 1;
  dvi_matrix_multiply(s->pencil.M, 0, ones, s->one);
  for (int64_t i = 0; i < f->unknowns; i++)
    if (f->component[i] >= 0) s->weight[f->component[i]] += s->one[i];
}

/* Tell if a mode, x.M x = 1, is made of constants on the free components. */
static int is_zero_mode(const spectrum *s, const double *x, double *sum)
{
  const dvi_field *f = s->field;
  double part = 0;
  for (int64_t c = 0; c < f->components; c++) sum[c] = 0;
  for (int64_t i = 0; i < f->unknowns; i++)
    if (f->component[i] >= 0) sum[f->component[i]] += s->one[i] * x[i];
  for (int64_t c = 0; c < f->components; c++) part += sum[c] * sum[c] / s->weight[c];
  return part > 0.5;
}

/* Move the modes that are not zero to the front. Returns their number. */
static int drop_zero_modes(spectrum *s, double *sum)
{
  const size_t n = (size_t)s->field->unknowns;
  int kept = 0;
  for (int i = 0; i < s->asked; i++) {
    const double *x = s->vector + (size_t)i * n;
    if (s->field->components > 0 && is_zero_mode(s, x, sum)) continue;
    s->value[kept] = s->value[i];
    if (kept != i) memcpy(s->vector + (size_t)kept * n, x, n * sizeof *x);
    kept++;
  }
  return kept;
}

/* ---- modes ---- */

static dvi_status find(spectrum *s, const dvi_modes_options *options, double *eigenvalue,
                       double *mode)
{
  const dvi_field *f = s->field;
  const double below = f->components > 0 ? dvi__shift_below_zero(f) : 0,
               shift = options->shift != 0 ? options->shift : below;
  weigh_components(s);
  DVI_TRY(dvi__modes_near(&s->pencil, shift, s->asked, s->value, s->vector));
  const int kept = drop_zero_modes(s, s->weight + f->components);
  const int first = dvi__first_of_nearest(kept, s->value, s->count, shift);
  memcpy(eigenvalue, s->value + first, (size_t)s->count * sizeof *eigenvalue);
  dvi__spread_modes(f, s->count, s->vector + (int64_t)first * f->unknowns, mode);
  return DVI_OK;
}

static dvi_status check_count(const spectrum *s, int64_t zeros)
{
  const int64_t most = s->field->unknowns - zeros;
  if (s->count >= 1 && s->count <= most) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE,
                   "field: %d modes of %lld unknowns, of which %lld are constants: "
                   "take 1 to %lld",
                   s->count, (long long)s->field->unknowns, (long long)zeros, (long long)most);
}

dvi_status dvi_field_modes(const dvi_field *field, const dvi_modes_options *options,
                           double *eigenvalue, double *mode, int64_t *zeros)
{
  const dvi_modes_options defaults = {.size = sizeof defaults};
  dvi_matrix K, M;
  if (options == NULL) options = &defaults;
  if (field == NULL || eigenvalue == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: a field and eigenvalues are needed");
  if (options->size != sizeof defaults)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: set options.size to sizeof(dvi_modes_options)");
  DVI_TRY(dvi__refuse_share(field->mesh, "field: modes"));
  if (field->degree > 0) return dvi__field_modes_of_form(field, options, eigenvalue, mode, zeros);
  DVI_TRY(dvi_field_matrix(field, DVI_FIELD_STIFFNESS, &K));
  DVI_TRY(dvi_field_matrix(field, DVI_FIELD_MASS, &M));
  const int64_t n = field->unknowns, components = field->components;
  spectrum s = {.field = field,
                .pencil = {.K = &K, .M = &M, .dimension = field->mesh->n},
                .count = options->count != 0 ? options->count : 6};
  DVI_TRY(check_count(&s, components));
  s.asked = s.count + (int)components;
  s.value = DVI_NEW(double, s.asked + (s.asked + 1) * n + 2 * components);
  if (s.value == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory for %d modes", s.asked);
  s.vector = s.value + s.asked;
  s.one = s.vector + s.asked * n;
  s.weight = s.one + n;
  const dvi_status status = find(&s, options, eigenvalue, mode);
  dvi__release(s.value);
  if (status == DVI_OK && zeros != NULL) *zeros = components;
  return status;
}

/* ---- the fastest frequency ---- */

static dvi_status find_fastest(const dvi_field *field, double *bound)
{
  dvi_matrix K, M;
  DVI_TRY(dvi_field_matrix(field, DVI_FIELD_STIFFNESS, &K));
  DVI_TRY(dvi_field_matrix(field, DVI_FIELD_MASS, &M));
  const dvi__pencil pencil = {.K = &K, .M = &M, .dimension = field->mesh->n};
  const dvi__cell_unknowns unknowns = {.mesh = field->mesh,
                                       .degree = field->degree,
                                       .components = 1,
                                       .count = field->unknowns,
                                       .total = field->whole_unknowns,
                                       .place = field->unknown};
  return dvi__largest_on_share(&pencil, &unknowns, bound);
}

dvi_status dvi_field_fastest(const dvi_field *field, double *omega)
{
  double bound;
  if (field == NULL || omega == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: a field and a place for a frequency are needed");
  *omega = field->fastest;
  if (*omega > 0) return DVI_OK;
  DVI_TRY(find_fastest(field, &bound));
  *omega = sqrt(fmax(bound, 0));
  ((dvi_field *)field)->fastest = *omega; /* the same number in every thread */
  return DVI_OK;
}
