/* A field of rotations R(t,x), with differences in space that are rotations, too. With the volumes
 * w of the nodes and the areas over the lengths s of the edges its Lagrangian is
 *
 *     L = sum_a w_a Omega_a.J Omega_a/2 - sum_ab s_ab tr((I - R_a^T R_b) Kd) - sum_a w_a V(R_a),
 *     Kd = tr(K)/2 I - K,
 *
 * because tr((I - exp(e^)) Kd) = e.K e/2 for small e. The second sum is quadratic in the entries of
 * the rotations. Differences in time are those of the method, with lie-verlet
 * tr((I - R_j^T R_{j+1}) Jd)/h.
 * Sources: Leok 2004, sec. 5.1; Moser and Veselov 1991; Demoures and others 2015. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/rotations/rotations.h"

/* ---- callbacks ---- */

/* Return row i of H q. */
static double times(const dvi__csr *H, int64_t i, const double *q)
{
  double sum = 0;
  for (int64_t e = H->start[i]; e < H->start[i + 1]; e++) sum += H->value[e] * q[H->column[e]];
  return sum;
}

static int bending_value(double t, const double *q, double *V, void *user)
{
  const dvi_rotations *f = user;
  (void)t;
  *V = f->constant;
  for (int64_t i = 0; i < f->hessian.rows; i++)
    *V += q[i] * (0.5 * times(&f->hessian, i, q) - f->load[i]);
  return 0;
}

static int bending_gradient(double t, const double *q, double *V_q, void *user)
{
  const dvi_rotations *f = user;
  (void)t;
  for (int64_t i = 0; i < f->hessian.rows; i++) V_q[i] = times(&f->hessian, i, q) - f->load[i];
  return 0;
}

/* The pattern's columns are the rows of the symmetric matrix. */
static int bending_hessian(double t, const double *q, double *V_qq, void *user)
{
  const dvi__csr *H = &((const dvi_rotations *)user)->hessian;
  (void)t, (void)q;
  memcpy(V_qq, H->value, (size_t)H->start[H->rows] * sizeof *V_qq);
  return 0;
}

/* Scale `count` results of a node by its volume, if they are wanted. */
static void weigh(double volume, int count, double *result)
{
  for (int i = 0; i < count && result != NULL; i++) result[i] *= volume;
}

/* Evaluate the potential at all nodes. Results that are not wanted are NULL. */
static int evaluate_potential(const dvi_rotations *f, const double *q, double *V, double *V_q,
                              double *V_qq)
{
  int failed = 0;
  for (int64_t a = 0; a < f->unknowns && failed == 0; a++) {
    double value = 0, *V_R = V_q != NULL ? V_q + DVI__ENTRIES * a : NULL,
           *V_RR = V_qq != NULL ? V_qq + (ptrdiff_t)DVI__ENTRIES * DVI__ENTRIES * a : NULL;
    failed = f->potential.density(f->x + a * f->axes, q + DVI__ENTRIES * a,
                                  V != NULL ? &value : NULL, V_R, V_RR, f->potential.user);
    if (V != NULL) *V += f->volume[a] * value;
    weigh(f->volume[a], DVI__ENTRIES, V_R);
    weigh(f->volume[a], DVI__ENTRIES * DVI__ENTRIES, V_RR);
  }
  return failed;
}

static int potential_value(double t, const double *q, double *V, void *user)
{
  (void)t;
  *V = 0;
  return evaluate_potential(user, q, V, NULL, NULL);
}

static int potential_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t;
  return evaluate_potential(user, q, NULL, V_q, NULL);
}

static int potential_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t;
  return evaluate_potential(user, q, NULL, NULL, V_qq);
}

/* A turn of space about the axis k has the body velocity R^T e_k, a row of R. */
static int turn(const dvi_rotations *f, const double *q, int k, double *xi)
{
  for (int64_t a = 0; a < f->unknowns; a++)
    memcpy(xi + 3 * a, q + DVI__ENTRIES * a + 3 * k, 3 * sizeof *xi);
  return 0;
}

static int turn_x(const double *q, double *xi, void *user)
{
  return turn(user, q, 0, xi);
}

static int turn_y(const double *q, double *xi, void *user)
{
  return turn(user, q, 1, xi);
}

static int turn_z(const double *q, double *xi, void *user)
{
  return turn(user, q, 2, xi);
}

/* ---- checks ---- */

static dvi_status check_axis(const dvi_rotations_terms *terms, int d)
{
  const dvi_axis *axis = terms->axis + d;
  if (!isfinite(axis->from) || !isfinite(axis->to) || !(axis->from < axis->to))
    return dvi__fail(DVI_BAD_ARGUMENT, "rotations: axis %d goes from %g to %g", d, axis->from,
                     axis->to);
  if (terms->cells[d] < (axis->periodic ? 3 : 1))
    return dvi__fail(DVI_BAD_ARGUMENT, "rotations: axis %d has %d cells; %s", d, terms->cells[d],
                     axis->periodic ? "a periodic one needs 3" : "1 is the least");
  const int *clamped = terms->is_clamped != NULL ? terms->is_clamped + 2 * (ptrdiff_t)d : NULL;
  if (clamped != NULL && (clamped[0] || clamped[1])) {
    if (axis->periodic)
      return dvi__fail(DVI_BAD_ARGUMENT, "rotations: axis %d is periodic, and its end is held", d);
    if (terms->held == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "rotations: an end of axis %d is held: give what it is",
                       d);
  }
  return DVI_OK;
}

static dvi_status check_matrix(const char *name, const double *A)
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      if (!isfinite(A[3 * i + j]) || A[3 * i + j] != A[3 * j + i])
        return dvi__fail(DVI_BAD_ARGUMENT, "rotations: the %s is not symmetric and finite at %d,%d",
                         name, i, j);
  return DVI_OK;
}

static dvi_status check_terms(const dvi_rotations_terms *terms)
{
  if (terms->size != sizeof *terms)
    return dvi__fail(DVI_BAD_ARGUMENT, "rotations: set terms.size to sizeof(dvi_rotations_terms)");
  if (terms->axes < 1 || terms->axes > DVI_AXES_MAX || !terms->axis || !terms->cells)
    return dvi__fail(DVI_BAD_ARGUMENT, "rotations: 1 to %d axes and their cells are needed",
                     (int)DVI_AXES_MAX);
  if (terms->inertia == NULL || terms->stiffness == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "rotations: inertia and stiffness are needed");
  if (terms->potential != NULL && terms->potential->density == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "rotations: the potential has no density");
  DVI_TRY(check_matrix("inertia", terms->inertia));
  for (int d = 0; d < terms->axes; d++) {
    DVI_TRY(check_axis(terms, d));
    DVI_TRY(check_matrix("stiffness", terms->stiffness + DVI__ENTRIES * (ptrdiff_t)d));
  }
  return DVI_OK;
}

/* ---- create ---- */

static void copy_terms(dvi_rotations *f, const dvi_rotations_terms *terms)
{
  f->axes = terms->axes;
  memcpy(f->inertia, terms->inertia, sizeof f->inertia);
  if (terms->potential != NULL) f->potential = *terms->potential;
  for (int d = 0; d < f->axes; d++) {
    const double *K = terms->stiffness + DVI__ENTRIES * (ptrdiff_t)d;
    f->periodic[d] = terms->axis[d].periodic;
    f->count[d] = terms->cells[d] + !f->periodic[d];
    f->lower[d] = terms->axis[d].from;
    f->length[d] = (terms->axis[d].to - terms->axis[d].from) / terms->cells[d];
    for (int end = 0; end < 2 && terms->is_clamped != NULL; end++)
      f->is_clamped[d][end] = terms->is_clamped[2 * d + end];
    for (int i = 0; i < DVI__ENTRIES; i++)
      f->bending[d][i] = (i % 4 == 0 ? (K[0] + K[4] + K[8]) / 2 : 0) - K[i];
  }
}

/* Make the factors, and the patterns of the Hessians. */
static dvi_status make_terms(dvi_rotations *f)
{
  const int64_t rows = DVI__ENTRIES * f->unknowns;
  f->factor = DVI_NEW(dvi_factor, f->unknowns);
  f->moment = DVI_NEW(double, rows);
  f->hessian_start = DVI_NEW(int, rows + 1);
  f->block_start = DVI_NEW(int, rows + 1);
  f->block_row = DVI_NEW(int, rows *DVI__ENTRIES);
  if (!f->factor || !f->moment || !f->hessian_start || !f->block_start || !f->block_row)
    return dvi__fail(DVI_NO_MEMORY, "rotations: no memory for a system");
  for (int64_t a = 0; a < f->unknowns; a++) {
    for (int i = 0; i < DVI__ENTRIES; i++)
      f->moment[DVI__ENTRIES * a + i] = f->volume[a] * f->inertia[i];
    f->factor[a] = (dvi_factor){.kind = DVI_SO3, .inertia = f->moment + DVI__ENTRIES * a};
  }
  for (int64_t i = 0; i <= rows; i++) {
    f->hessian_start[i] = (int)f->hessian.start[i];
    f->block_start[i] = (int)(DVI__ENTRIES * i);
  }
  for (int64_t e = 0; e < rows * DVI__ENTRIES; e++)
    f->block_row[e] = (int)(e / (DVI__ENTRIES * DVI__ENTRIES) * DVI__ENTRIES + e % DVI__ENTRIES);
  return DVI_OK;
}

static void make_potentials(dvi_rotations *f)
{
  f->potentials[0] = (dvi_potential){.name = "bending",
                                     .value = bending_value,
                                     .gradient = bending_gradient,
                                     .hessian = bending_hessian,
                                     .qq = {f->hessian_start, f->hessian.column},
                                     .quadratic = 1,
                                     .user = f};
  f->potentials[1] = (dvi_potential){.name = "potential",
                                     .value = potential_value,
                                     .gradient = potential_gradient,
                                     .hessian = potential_hessian,
                                     .qq = {f->block_start, f->block_row},
                                     .user = f};
  f->symmetry[0] = (dvi_symmetry){"momentum_x", turn_x, f};
  f->symmetry[1] = (dvi_symmetry){"momentum_y", turn_y, f};
  f->symmetry[2] = (dvi_symmetry){"momentum_z", turn_z, f};
}

static dvi_status make(dvi_rotations *f, const dvi_rotations_terms *terms)
{
  copy_terms(f, terms);
  DVI_TRY(dvi__rotations_place(f, terms));
  DVI_TRY(dvi__rotations_bend(f));
  DVI_TRY(make_terms(f));
  make_potentials(f);
  return DVI_OK;
}

dvi_status dvi_rotations_create(const dvi_rotations_terms *terms, dvi_rotations **field)
{
  if (terms == NULL || field == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "rotations: terms and a place for the field are needed");
  *field = NULL;
  DVI_TRY(check_terms(terms));
  dvi_rotations *f = DVI_NEW(dvi_rotations, 1);
  if (f == NULL) return dvi__fail(DVI_NO_MEMORY, "rotations: no memory");
  const dvi_status status = make(f, terms);
  *field = f;
  if (status != DVI_OK) dvi_rotations_destroy(field);
  return status;
}

void dvi_rotations_destroy(dvi_rotations **field)
{
  if (field == NULL || *field == NULL) return;
  dvi_rotations *f = *field;
  dvi__csr_clear(&f->hessian);
  void *const owned[] = {f->number, f->held,          f->x,           f->volume,    f->load,
                         f->factor, f->hessian_start, f->block_start, f->block_row, f->moment};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  dvi__release(f);
  *field = NULL;
}

/* ---- questions ---- */

int64_t dvi_rotations_nodes(const dvi_rotations *field, const double **x, const double **volume)
{
  if (x != NULL) *x = field != NULL ? field->x : NULL;
  if (volume != NULL) *volume = field != NULL ? field->volume : NULL;
  return field != NULL ? field->unknowns : 0;
}

dvi_status dvi_rotations_system_terms(const dvi_rotations *field, dvi_system_terms *terms)
{
  if (field == NULL || terms == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "rotations: a field and a place for terms are needed");
  const int has_potential = field->potential.density != NULL;
  int is_free = !has_potential;
  for (int d = 0; d < field->axes; d++)
    is_free = is_free && !field->is_clamped[d][0] && !field->is_clamped[d][1];
  *terms = (dvi_system_terms){.factors = field->factor,
                              .factor_count = (int)field->unknowns,
                              .potentials = field->potentials,
                              .potential_count = 1 + has_potential,
                              .symmetries = is_free ? field->symmetry : NULL,
                              .symmetry_count = is_free ? 3 : 0,
                              .autonomous = 1};
  return DVI_OK;
}

dvi_status dvi_rotations_system(const dvi_rotations *field, dvi_system **system)
{
  dvi_system_terms terms;
  DVI_TRY(dvi_rotations_system_terms(field, &terms));
  return dvi_system_create(&terms, system);
}
