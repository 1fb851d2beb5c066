/* Modes of fields that processes share.
 *
 * Krylov and Schur's method (Stewart 2002), as SLEPc has it, finds those near a shift. Which modes
 * have the frequency zero is known, but for harmonic forms: constants of waves are kept away as
 * vectors to which all others are orthogonal, and gradients by a projection. */
#include <dvi/forms.h>
#include <dvi/petsc.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "modes.h"
#include "owners.h"

/* Part of the size of the lowest eigenvalues that zero is after roundings. */
static const double zero_of_lowest = 1e-6;
/* More than are asked for are found at first, because the last ones of several equal ones come
 * late. */
enum { MORE = 4, TRIES = 12 };
/* Factors of a mesh in space grow as n^(4/3), their operations as n^2. */
enum { MOST_IN_SPACE = 40000 };

typedef struct modes {
  dvi__modes_problem problem;
  dvi__inverse inverse;
  double shift, from; /* the shift asked for, and where it has been moved */
  int draws;          /* of starts */
  int64_t zeros, solutions, iterations;
  const char *solver;
} modes;

static dvi_status agree(const modes *m, dvi_status status)
{
  return dvi__world_agree(&m->problem.division->world, status);
}

/* ---- what has been found ---- */

static int is_zero(const modes *m, PetscInt pair)
{
  return pair < m->problem.constants ||
         (m->problem.degree > 0 &&
          fabs(m->problem.pairs.value[pair]) <= -zero_of_lowest * m->problem.below);
}

/* Return how many pairs are zero. Once sorted they are the first ones. */
static PetscInt count_zeros(const modes *m)
{
  PetscInt count = 0;
  for (PetscInt i = 0; i < m->problem.pairs.count; i++) count += is_zero(m, i);
  return count;
}

static int comes_before(const modes *m, PetscInt a, PetscInt b)
{
  const int zero_a = is_zero(m, a), zero_b = is_zero(m, b);
  return zero_a != zero_b ? zero_a
                          : !zero_a && m->problem.pairs.value[a] < m->problem.pairs.value[b];
}

/* Sort the pairs behind the known ones: zeros, then the others with ascending eigenvalues. */
static void sort_pairs(modes *m)
{
  const PetscInt known = m->problem.constants;
  for (PetscInt i = known + 1; i < m->problem.pairs.count; i++)
    for (PetscInt k = i; k > known && comes_before(m, k, k - 1); k--)
      dvi__pairs_swap(k, k - 1, &m->problem.pairs);
}

/* Return the first of the `count` sorted pairs that are not zero and the nearest to a shift. */
static PetscInt find_nearest(const modes *m, PetscInt count, double shift)
{
  const double *value = m->problem.pairs.value;
  PetscInt first = count_zeros(m);
  for (PetscInt last = m->problem.pairs.count; last - first > count;)
    if (fabs(value[first] - shift) > fabs(value[last - 1] - shift))
      first++;
    else
      last--;
  return first;
}

/* Return how far the last of the `count` nearest pairs is from the shift. */
static double find_reach(modes *m, PetscInt count)
{
  sort_pairs(m);
  const PetscInt first = find_nearest(m, count, m->from);
  return fmax(fabs(m->problem.pairs.value[first] - m->from),
              fabs(m->problem.pairs.value[first + count - 1] - m->from));
}

/* ---- iterations ---- */

static dvi__pencil_of_all pencil_of(modes *m)
{
  dvi__modes_problem *p = &m->problem;
  return (dvi__pencil_of_all){.comm = p->division->world.comm,
                              .K = p->K,
                              .mass = p->mass,
                              .root = p->root,
                              .shift = m->from,
                              .inverse = &m->inverse,
                              .gradients = p->gradients.count > 0 ? &p->gradients : NULL,
                              .start = p->start,
                              .room = {p->room[0], p->room[1]}};
}

static dvi_status find_more(modes *m, PetscInt count)
{
  const dvi__pencil_of_all pencil = pencil_of(m);
  DVI_TRY(agree(m, dvi__pairs_reserve(count, &m->problem.pairs)));
  DVI_TRY(dvi__modes_draw_start(&m->problem, m->draws++));
  return dvi__find_pairs(&pencil, count, &m->problem.pairs);
}

/* Tell whether the `wanted` nearest modes are among those that have been found. A vector can have
 * no part in the start of an iteration, as one of several with equal eigenvalues. Another one that
 * is orthogonal to all vectors found so far must not come as near. */
static dvi_status check_complete(modes *m, PetscInt wanted, int *is_complete)
{
  const double most = 0.99, reach = find_reach(m, wanted) + 2 * fabs(m->from - m->shift);
  const dvi__pencil_of_all pencil = pencil_of(m);
  double next;
  DVI_TRY(dvi__modes_draw_start(&m->problem, m->draws++));
  DVI_TRY(dvi__estimate_next(&pencil, &m->problem.pairs, &next));
  *is_complete = most * next > reach;
  return DVI_OK;
}

/* Find the `wanted` nearest modes that are not zero, or all. */
static dvi_status collect(modes *m, PetscInt wanted)
{
  const PetscInt all = m->problem.unknowns.total - m->problem.gradients.count;
  for (int is_complete = 0; m->problem.pairs.count < all;) {
    const PetscInt left = all - m->problem.pairs.count,
                   missing = wanted - (m->problem.pairs.count - count_zeros(m));
    if (missing <= 0) DVI_TRY(check_complete(m, wanted, &is_complete));
    if (is_complete) break;
    DVI_TRY(find_more(m, missing > 0 ? PetscMin(missing + MORE, left) : 1));
  }
  sort_pairs(m);
  return DVI_OK;
}

/* ---- near a shift ---- */

static PetscErrorCode shift_matrix(const modes *m, Mat *shifted)
{
  const dvi__modes_problem *p = &m->problem;
  PetscCall(MatDuplicate(p->K, MAT_COPY_VALUES, shifted));
  PetscCall(MatSetOption(*shifted, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscCall(VecCopy(p->mass, p->room[0]));
  PetscCall(VecScale(p->room[0], -m->from));
  return MatDiagonalSet(*shifted, p->room[0], ADD_VALUES);
}

static dvi_status prepare_inverse(modes *m)
{
  const dvi__modes_problem *p = &m->problem;
  dvi__equations equations = {.is_definite = m->from <= 0,
                              .is_large = p->is_large,
                              .edges = p->degree > 0 ? &p->gradients.edges : NULL};
  dvi_status status = dvi__check_petsc(shift_matrix(m, &equations.matrix));
  if (status == DVI_OK) status = dvi__inverse_create(&equations, &m->inverse);
  (void)MatDestroy(&equations.matrix);
  return status;
}

static void drop_inverse(modes *m)
{
  m->solutions += m->inverse.solutions;
  m->iterations += m->inverse.iterations;
  if (m->inverse.solver != NULL) m->solver = m->inverse.solver;
  dvi__inverse_clear(&m->inverse);
}

static dvi_status collect_near(modes *m, double from, PetscInt wanted)
{
  m->from = from;
  dvi__pairs_shorten(m->problem.constants, &m->problem.pairs);
  dvi_status status = prepare_inverse(m);
  if (status == DVI_OK) status = collect(m, wanted);
  drop_inverse(m);
  return status;
}

/* Roundings have left nothing of some modes if their equations do not hold. */
static dvi_status check_residuals(const modes *m)
{
  const double allowed = 1e-6;
  for (PetscInt i = 0; i < m->problem.pairs.count; i++)
    if (!(m->problem.pairs.residual[i] <= allowed * m->problem.mean))
      return dvi__fail(DVI_SINGULAR,
                       "modes: roundings of matrices with entries of very different sizes leave no "
                       "modes near the shift %g: take another one",
                       m->shift);
  return DVI_OK;
}

/* A shift at an eigenvalue makes K - shift M singular to roundoff. It is then moved by a small part
 * of the distance to the farthest eigenvalue, until the nearest one is not so near. */
static dvi_status collect_beside(modes *m, PetscInt wanted)
{
  const double near = 1e-6, part = 1e-5, unit = 1e-5 * m->problem.mean;
  double from = m->shift;
  for (int i = 0; i < TRIES; i++) {
    double nearest = INFINITY, farthest = 0;
    dvi_status status = collect_near(m, from, wanted);
    if (status == DVI_OK) status = check_residuals(m);
    if (status != DVI_OK && (status != DVI_SINGULAR || i + 1 == TRIES)) return status;
    for (PetscInt k = 0; k < m->problem.pairs.count && status == DVI_OK; k++) {
      nearest = fmin(nearest, fabs(m->problem.pairs.value[k] - from));
      farthest = fmax(farthest, fabs(m->problem.pairs.value[k] - from));
    }
    if (status == DVI_OK && nearest > near * farthest) return DVI_OK;
    from += (m->shift > 0 ? 1 : -1) * fmax(part * farthest, status == DVI_OK ? 0 : 1e-2 * unit);
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "modes: the shift %g lies within roundoff of many eigenvalues: take another one",
                   m->shift);
}

/* ---- zeros ---- */

/* Harmonic forms are counted as what is found at zero. Near a shift above 0 they may not be found,
 * and are looked for apart. */
static dvi_status count_harmonic(modes *m)
{
  m->shift = m->problem.below;
  DVI_TRY(collect_near(m, m->shift, 1));
  m->zeros = m->problem.gradients.count + count_zeros(m);
  return DVI_OK;
}

static dvi_status check_count(const modes *m, int count, int64_t most)
{
  if (count >= 1 && count <= most) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE,
                   "field: %d modes of %lld unknowns, of which %lld are %s: take 1 to %lld", count,
                   (long long)m->problem.unknowns.total, (long long)m->zeros,
                   m->problem.degree > 0 ? "static" : "constants", (long long)most);
}

static dvi_status find(modes *m, const dvi_modes_options *options, int count)
{
  const dvi__modes_problem *p = &m->problem;
  const int is_form = p->degree > 0;
  m->zeros = is_form ? p->gradients.count : p->constants;
  DVI_TRY(check_count(m, count, p->unknowns.total - m->zeros));
  if (is_form && options->shift > 0) DVI_TRY(count_harmonic(m));
  DVI_TRY(check_count(m, count, p->unknowns.total - m->zeros));
  m->shift = options->shift;
  if (m->shift == 0 && (is_form || m->zeros > 0)) m->shift = p->below;
  DVI_TRY(collect_beside(m, count));
  if (is_form && !(options->shift > 0)) m->zeros = p->gradients.count + count_zeros(m);
  return check_count(m, count, m->problem.pairs.count - count_zeros(m));
}

/* ---- results ---- */

/* Let the first entry of all that is at least half of the largest one be positive, so that equal
 * problems have equal modes. */
static dvi_status choose_sign(dvi_division *division, int k, int64_t cells, double *form)
{
  void *world = (void *)&division->world;
  const int64_t *number = dvi_mesh_share_numbers(division->share, k);
  double most = 0, first = -INFINITY, is_negative = 0;
  for (int64_t c = 0; c < cells; c++) most = fmax(most, fabs(form[c]));
  if (dvi__world_largest(1, &most, world) != 0) return dvi__world_fail(world);
  for (int64_t c = cells - 1; c >= 0; c--)
    if (fabs(form[c]) >= 0.5 * most) {
      first = -(double)number[c];
      is_negative = form[c] < 0;
    }
  double firsts[] = {first};
  if (dvi__world_largest(1, firsts, world) != 0) return dvi__world_fail(world);
  if (first < firsts[0]) is_negative = 0;
  if (dvi__world_largest(1, &is_negative, world) != 0) return dvi__world_fail(world);
  for (int64_t c = 0; c < cells && is_negative > 0; c++) form[c] = -form[c];
  return DVI_OK;
}

static PetscErrorCode fill_form(const dvi__modes_problem *p, Vec y, double *form)
{
  const PetscScalar *value, *root;
  PetscCall(VecGetArrayRead(y, &value));
  PetscCall(VecGetArrayRead(p->root, &root));
  for (PetscInt i = 0; i < p->unknowns.own; i++) form[p->unknowns.cell[i]] = value[i] / root[i];
  PetscCall(VecRestoreArrayRead(p->root, &root));
  return VecRestoreArrayRead(y, &value);
}

static dvi_status give_mode(const dvi__modes_problem *p, Vec y, double *form)
{
  const int64_t cells = dvi_mesh_count(p->division->share, p->degree);
  memset(form, 0, (size_t)cells * sizeof *form);
  DVI_TRY(dvi__check_petsc(fill_form(p, y, form)));
  DVI_TRY(dvi_division_refresh(p->division, p->degree, form));
  return choose_sign(p->division, p->degree, cells, form);
}

/* Give the `count` pairs that are the nearest to the shift. `mode` is written first, which may
 * fail. */
static dvi_status give(const modes *m, int count, double *eigenvalue, double *mode,
                       dvi_modes_facts *facts)
{
  const dvi__pairs *pairs = &m->problem.pairs;
  const int64_t cells = dvi_mesh_count(m->problem.division->share, m->problem.degree);
  const PetscInt first = find_nearest(m, count, m->shift);
  double residual = 0;
  for (int i = 0; i < count && mode != NULL; i++)
    DVI_TRY(give_mode(&m->problem, pairs->vector[first + i], mode + i * cells));
  for (int i = 0; i < count; i++) {
    eigenvalue[i] = pairs->value[first + i];
    residual = fmax(residual, pairs->residual[first + i] / fabs(eigenvalue[i]));
  }
  if (facts != NULL)
    *facts = (dvi_modes_facts){.unknowns = m->problem.unknowns.total,
                               .zeros = m->zeros,
                               .solver = m->solver,
                               .solutions = m->solutions,
                               .iterations = m->iterations,
                               .residual = residual};
  return DVI_OK;
}

/* ---- for users ---- */

static dvi_status check(dvi_division *division, const dvi_field *field,
                        const dvi_modes_options *options, const double *eigenvalue)
{
  if (division == NULL || field == NULL || eigenvalue == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "modes: a division, a field on its share and eigenvalues are needed");
  if (options != NULL && options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "modes: set options.size to sizeof(dvi_modes_options)");
  if (options != NULL && !isfinite(options->shift))
    return dvi__fail(DVI_BAD_ARGUMENT, "modes: the shift is %g", options->shift);
  if (dvi_star_mesh(dvi_field_star(field)) != division->share)
    return dvi__fail(DVI_BAD_ARGUMENT, "modes: the field is not on the share of this division");
  return DVI_OK;
}

dvi_status dvi__find_modes(const dvi__modes_request *r, double *eigenvalue, double *mode,
                           dvi_modes_facts *facts)
{
  const int count = r->options->count != 0 ? r->options->count : 6;
  modes m = {.problem = {.division = r->division, .field = r->field, .most = r->most}};
  dvi_status status = dvi__modes_problem_create(&m.problem);
  if (status == DVI_OK) status = find(&m, r->options, count);
  if (status == DVI_OK) status = give(&m, count, eigenvalue, mode, facts);
  dvi__modes_problem_clear(&m.problem);
  return status;
}

dvi_status dvi_division_modes(dvi_division *division, const dvi_field *field,
                              const dvi_modes_options *options, double *eigenvalue, double *mode,
                              dvi_modes_facts *facts)
{
  const dvi_modes_options defaults = {.size = sizeof defaults};
  DVI_TRY(check(division, field, options, eigenvalue));
  const dvi__modes_request request = {.division = division,
                                      .field = field,
                                      .options = options != NULL ? options : &defaults,
                                      .most = MOST_IN_SPACE};
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  const dvi_status status = dvi__find_modes(&request, eigenvalue, mode, facts);
  (void)PetscPopErrorHandler();
  return status;
}
