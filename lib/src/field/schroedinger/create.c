/* Creation of Schroedinger's equation: its checks, the free functions, and the matrices. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/schroedinger/schroedinger.h"
#include "field/space/kind.h"

/* ---- checks ---- */

/* Refuse units in which kinetic energies, and their products with slopes, underflow or overflow. */
static dvi_status check_units(const dvi_schroedinger_terms *terms)
{
  const double hbar = terms->hbar > 0 ? terms->hbar : 1, mass = terms->mass > 0 ? terms->mass : 1,
               kinetic = hbar * hbar / (2 * mass);
  if (kinetic >= 1e-200 && kinetic <= 1e200) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "schroedinger: hbar = %g and mass = %g make hbar^2/(2 mass) = %g, which should "
                   "be from 1e-200 to 1e200; take units in which hbar and mass are near 1",
                   hbar, mass, kinetic);
}

static dvi_status check(const dvi_schroedinger_terms *terms)
{
  if (terms == NULL || terms->size != sizeof *terms)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: set terms.size to sizeof(dvi_schroedinger_terms)");
  if (terms->space == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "schroedinger: a space is needed");
  if (!(terms->hbar >= 0) || isinf(terms->hbar) || !(terms->mass >= 0) || isinf(terms->mass))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: hbar = %g and mass = %g; both are above 0 and finite",
                     terms->hbar, terms->mass);
  DVI_TRY(check_units(terms));
  if (terms->radial != 0 && terms->radial != 2 && terms->radial != 3)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: radial = %d; 2 and 3 dimensions of space are possible, and 0 "
                     "for a coordinate that is no radius",
                     terms->radial);
  return DVI_OK;
}

static dvi_status check_radius(const dvi_schroedinger *s)
{
  if (s->radial == 0) return DVI_OK;
  if (s->dimension != 1 || s->is_fourier)
    return dvi__fail(DVI_UNSUPPORTED,
                     "schroedinger: a radius needs a space with one axis that is not periodic, as "
                     "fem, splines or polynomials on it");
  for (int64_t k = 0; k < s->points; k++)
    if (s->x[k] < 0)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "schroedinger: the radius is %g at a point; let the axis begin at 0",
                       s->x[k]);
  return DVI_OK;
}

/* ---- free functions ---- */

/* Mark the functions of one part of the boundary as fixed. */
static dvi_status fix_part(const dvi_schroedinger *s, const char *part, char *is_fixed)
{
  int64_t count = 0;
  const int *function = dvi_space_boundary(s->space, part, &count);
  if (function == NULL && strcmp(part, "boundary") != 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: the space has no part \"%s\" of a boundary; fixed has parts "
                     "such as left and right, boundary for all, or none",
                     part);
  for (int64_t i = 0; i < count && function != NULL; i++) is_fixed[function[i]] = 1;
  return DVI_OK;
}

static dvi_status fix(const dvi_schroedinger *s, const char *names, char *is_fixed)
{
  enum { LONGEST = 64 };
  static const char between[] = " ,";
  if (strcmp(names, "none") == 0) return DVI_OK;
  for (names += strspn(names, between); *names != '\0'; names += strspn(names, between)) {
    char part[LONGEST];
    const size_t length = strcspn(names, between);
    (void)snprintf(part, sizeof part, "%.*s", (int)(length < LONGEST ? length : LONGEST - 1),
                   names);
    DVI_TRY(fix_part(s, part, is_fixed));
    names += length;
  }
  return DVI_OK;
}

static dvi_status number_free(dvi_schroedinger *s, const char *is_fixed)
{
  for (int64_t i = 0; i < s->functions; i++)
    if (!is_fixed[i]) s->place[s->free++] = (int)i;
  if (s->free > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "schroedinger: all %lld functions are fixed at the boundary; take more cells",
                   (long long)s->functions);
}

static dvi_status find_free(dvi_schroedinger *s, const char *names)
{
  char *is_fixed = DVI_NEW(char, s->functions);
  s->place = DVI_NEW(int, s->functions);
  dvi_status status = DVI_OK;
  if (is_fixed == NULL || s->place == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld functions",
                       (long long)s->functions);
  if (status == DVI_OK) status = fix(s, names != NULL ? names : "boundary", is_fixed);
  if (status == DVI_OK) status = number_free(s, is_fixed);
  dvi__release(is_fixed);
  return status;
}

/* ---- points ---- */

static double measure(const dvi_schroedinger *s, int64_t k)
{
  const double pi = 3.141592653589793, x = s->x[k];
  return s->radial == 2 ? 2 * pi * x : s->radial == 3 ? 4 * pi * x * x : 1;
}

static dvi_status take_interaction(dvi_schroedinger *s, const dvi_schroedinger_terms *terms)
{
  if (terms->interaction == 0 && terms->interaction_at == NULL) return DVI_OK;
  s->beta = DVI_NEW(double, s->points);
  if (s->beta == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld points",
                     (long long)s->points);
  for (int64_t k = 0; k < s->points; k++) s->beta[k] = terms->interaction;
  const int failure = terms->interaction_at != NULL
                          ? terms->interaction_at(s->points, s->x, s->beta, terms->user)
                          : 0;
  if (failure != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "schroedinger: the interaction failed with %d", failure);
  return dvi__schroedinger_check(s, "interaction", s->beta);
}

static dvi_status take_points(dvi_schroedinger *s, const dvi_schroedinger_terms *terms)
{
  const double *weight;
  s->points = dvi_space_points(s->space, &s->x, &weight);
  DVI_TRY(check_radius(s));
  s->weight = DVI_NEW(double, s->points);
  s->still = DVI_NEW(double, s->points);
  if (s->weight == NULL || s->still == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld points",
                     (long long)s->points);
  for (int64_t k = 0; k < s->points; k++) s->weight[k] = weight[k] * measure(s, k);
  DVI_TRY(take_interaction(s, terms));
  s->depends_on_time = s->potential != NULL; /* the potential is asked for once at least */
  DVI_TRY(dvi__schroedinger_potential(s, 0, s->still));
  s->depends_on_time = s->potential != NULL && terms->depends_on_time;
  return DVI_OK;
}

/* ---- matrices ---- */

/* Give the part of an operator that acts on free functions. */
static dvi_status select_free(const dvi_schroedinger *s, const dvi__csr *matrix, dvi__csr *part)
{
  const dvi_matrix view = dvi__csr_view(matrix, 0);
  const int64_t count = s->points > s->functions ? s->points : s->functions;
  int *row = DVI_NEW(int, 2 * count);
  if (row == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld rows", (long long)count);
  int *column = row + count;
  for (int64_t k = 0; k < s->points; k++) row[k] = (int)k;
  for (int64_t i = 0; i < s->functions; i++) column[i] = -1;
  for (int64_t i = 0; i < s->free; i++) column[s->place[i]] = (int)i;
  const dvi__selection chosen = {row, column, s->points, s->free};
  const dvi_status status = dvi__csr_select(&view, &chosen, part);
  dvi__release(row);
  return status;
}

/* Add B^T diag(w) B to the sum, and keep its entries. */
static dvi_status add_square(const dvi_schroedinger *s, const dvi__csr *B, double factor,
                             dvi__csr *sum)
{
  double *w = DVI_NEW(double, s->points);
  if (w == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld weights",
                     (long long)s->points);
  for (int64_t k = 0; k < s->points; k++) w[k] = factor * s->weight[k];
  const dvi_matrix view = dvi__csr_view(B, 0), W = {.rows = s->points,
                                                    .columns = s->points,
                                                    .width = 1,
                                                    .symmetric = 1,
                                                    .value = w};
  dvi__csr square = {0}, more = {0};
  dvi_status status = dvi__csr_square(&view, &W, &square);
  const dvi_matrix old = dvi__csr_view(sum, 1), added = dvi__csr_view(&square, 1);
  if (status == DVI_OK && sum->start != NULL) status = dvi__csr_sum(&old, &added, &more);
  if (status == DVI_OK && sum->start != NULL) {
    dvi__csr_clear(sum);
    *sum = more;
    dvi__csr_clear(&square);
  } else if (status == DVI_OK) {
    *sum = square;
  } else {
    dvi__csr_clear(&square);
  }
  dvi__release(w);
  return status;
}

/* Sum the kinetic energy over the axes, in a pattern that has the entries of the mass, too. */
static dvi_status sum_kinetic(dvi_schroedinger *s)
{
  DVI_TRY(add_square(s, &s->B, 0, &s->T));
  for (int d = 0; d < s->dimension; d++) {
    dvi__csr slope = {0};
    DVI_TRY(select_free(s, &s->slope[d].matrix, &slope));
    const dvi_status status = add_square(s, &slope, s->hbar * s->hbar / (2 * s->mass), &s->T);
    dvi__csr_clear(&slope);
    DVI_TRY(status);
  }
  return DVI_OK;
}

static dvi_status check_mass(const dvi_schroedinger *s)
{
  for (int64_t i = 0; i < s->free; i++)
    if (!(s->M[dvi__csr_find(&s->T, i, (int)i)] > 0))
      return dvi__fail(DVI_SINGULAR,
                       "schroedinger: function %d has no mass; a radius needs quadrature points "
                       "beside 0, as fem without lumped=yes has",
                       s->place[i]);
  return DVI_OK;
}

static dvi_status make_matrices(dvi_schroedinger *s)
{
  DVI_TRY(select_free(s, &s->values.matrix, &s->B));
  DVI_TRY(sum_kinetic(s));
  const int64_t entries = s->T.start[s->free];
  s->M = DVI_NEW(double, entries);
  if (s->M == NULL || entries > INT_MAX)
    return dvi__fail(entries > INT_MAX ? DVI_BAD_SIZE : DVI_NO_MEMORY,
                     "schroedinger: matrices with %lld entries are too large", (long long)entries);
  dvi__schroedinger_add_square(s, NULL, s->M);
  return check_mass(s);
}

/* -hbar^2/(2m) times the second derivatives of cosines and sines. */
static dvi_status make_diagonal(dvi_schroedinger *s)
{
  s->diagonal = DVI_NEW(double, s->free);
  if (s->diagonal == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld modes", (long long)s->free);
  for (int d = 0; d < s->dimension; d++) {
    int order[DVI_AXES_MAX] = {0};
    order[d] = 2;
    for (int64_t i = 0; i < s->free; i++)
      s->diagonal[i] -= s->hbar * s->hbar / (2 * s->mass) *
                        dvi__fourier_derivative(s->space, order, i).factor;
  }
  return DVI_OK;
}

static dvi_status make_operators(dvi_schroedinger *s)
{
  const int none[DVI_AXES_MAX] = {0};
  DVI_TRY(dvi__operator_make(s->space, none, &s->values));
  for (int d = 0; d < s->dimension; d++) {
    int order[DVI_AXES_MAX] = {0};
    order[d] = 1;
    DVI_TRY(dvi__operator_make(s->space, order, s->slope + d));
  }
  return s->is_fourier ? make_diagonal(s) : make_matrices(s);
}

/* ---- creation ---- */

static dvi_status make(const dvi_schroedinger_terms *terms, dvi_schroedinger *s)
{
  s->space = dvi_space_share(terms->space);
  s->hbar = terms->hbar > 0 ? terms->hbar : 1;
  s->mass = terms->mass > 0 ? terms->mass : 1;
  s->dimension = dvi_space_dimension(s->space);
  s->radial = terms->radial;
  s->is_fourier = dvi__space_is_fourier(s->space);
  s->potential = terms->potential;
  s->user = terms->user;
  s->functions = dvi_space_functions(s->space);
  if (s->functions > INT_MAX / 4)
    return dvi__fail(DVI_BAD_SIZE, "schroedinger: %lld functions are too many",
                     (long long)s->functions);
  DVI_TRY(find_free(s, terms->fixed));
  DVI_TRY(take_points(s, terms));
  return make_operators(s);
}

dvi_status dvi_schroedinger_create(const dvi_schroedinger_terms *terms, dvi_schroedinger **equation)
{
  if (equation == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "schroedinger: a place for the equation is needed");
  *equation = NULL;
  DVI_TRY(check(terms));
  dvi_schroedinger *s = DVI_NEW(dvi_schroedinger, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory");
  const dvi_status status = make(terms, s);
  if (status == DVI_OK)
    *equation = s;
  else
    dvi_schroedinger_destroy(&s);
  return status;
}

void dvi_schroedinger_destroy(dvi_schroedinger **equation)
{
  if (equation == NULL || *equation == NULL) return;
  dvi_schroedinger *s = *equation;
  double *const arrays[] = {s->weight, s->still, s->beta, s->M, s->diagonal};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) dvi__release(arrays[i]);
  dvi__release(s->place);
  dvi__operator_clear(&s->values);
  for (int d = 0; d < 3; d++) dvi__operator_clear(s->slope + d);
  dvi__csr_clear(&s->B);
  dvi__csr_clear(&s->T);
  dvi_space_destroy(&s->space);
  dvi__release(s);
  *equation = NULL;
}

const dvi_space *dvi_schroedinger_space(const dvi_schroedinger *equation)
{
  return equation != NULL ? equation->space : NULL;
}

void dvi_schroedinger_explain(const dvi_schroedinger *equation, char *text, size_t size)
{
  if (text == NULL || size == 0) return;
  text[0] = '\0';
  if (equation == NULL) return;
  const dvi_schroedinger *s = equation;
  dvi__note note = {text, size, 0};
  dvi__note_add(&note, "hbar = %g, mass = %g\n%lld free of %lld functions, %lld points\n", s->hbar,
                s->mass, (long long)s->free, (long long)s->functions, (long long)s->points);
  dvi__note_add(&note, "%s, %s\n",
                s->potential == NULL ? "no potential"
                : s->depends_on_time ? "a potential of x and t"
                                     : "a potential of x",
                s->beta != NULL ? "an interaction beta |psi|^2" : "no interaction");
  if (s->radial > 0)
    dvi__note_add(&note, "a radius with the measure %s\n", s->radial == 2 ? "2 pi x" : "4 pi x^2");
  if (s->is_fourier)
    dvi__note_add(&note, "diagonal kinetic energy, and no matrices\n");
  else
    dvi__note_add(&note, "sparse matrices with %lld entries\n", (long long)s->T.start[s->free]);
}
