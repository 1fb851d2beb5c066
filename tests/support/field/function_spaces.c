#include "support/field/function_spaces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/suite.h"

extern void dsygv_(const int *type, const char *job, const char *part, const int *n, double *a,
                   const int *lda, double *b, const int *ldb, double *w, double *work,
                   const int *lwork, int *info, size_t job_length, size_t part_length);

dvi_space *space_on_line(const char *kind, double from, double to, int periodic)
{
  const dvi_axis axis = {.from = from, .to = to, .periodic = periodic};
  const dvi_space_options options = {
      .size = sizeof options, .kind = kind, .axis = &axis, .axes = 1};
  dvi_space *space = NULL;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  return space;
}

dvi_space *space_on_box(const char *kind, int axes, double length, int periodic)
{
  dvi_axis axis[DVI_AXES_MAX] = {{0}};
  for (int d = 0; d < axes; d++) axis[d] = (dvi_axis){.to = length, .periodic = periodic};
  const dvi_space_options options = {
      .size = sizeof options, .kind = kind, .axis = axis, .axes = axes};
  dvi_space *space = NULL;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  return space;
}

dvi_space *space_on_mesh(const char *kind, const dvi_mesh *mesh)
{
  const dvi_space_options options = {.size = sizeof options, .kind = kind, .mesh = mesh};
  dvi_space *space = NULL;
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  return space;
}

static void add_derivative(const dvi_space *space, int axis, int order, double *form)
{
  const int n = (int)dvi_space_functions(space);
  const double *weight;
  const int64_t points = dvi_space_points(space, NULL, &weight);
  double *U = calloc((size_t)n, sizeof *U), *B = calloc((size_t)(n * points) + 1, sizeof *B);
  int orders[DVI_AXES_MAX] = {0}, *at = calloc((size_t)n, sizeof *at);
  orders[axis] = order;
  for (int i = 0; i < n; i++) {
    U[i] = 1;
    ck_assert_msg(dvi_space_apply(space, orders, U, B + i * points) == DVI_OK, "%s",
                  dvi_last_error());
    U[i] = 0;
  }
  for (int64_t k = 0; k < points; k++) {
    int count = 0;
    for (int i = 0; i < n; i++)
      if (B[i * points + k] != 0) at[count++] = i;
    for (int i = 0; i < count; i++)
      for (int j = 0; j < count; j++)
        form[at[i] * n + at[j]] += weight[k] * B[at[i] * points + k] * B[at[j] * points + k];
  }
  free(U);
  free(B);
  free(at);
}

space_forms forms_of_space(const dvi_space *space)
{
  space_forms forms = {.n = (int)dvi_space_functions(space)};
  const size_t entries = (size_t)forms.n * (size_t)forms.n;
  forms.mass = calloc(entries, sizeof *forms.mass);
  forms.stiffness = calloc(entries, sizeof *forms.stiffness);
  add_derivative(space, 0, 0, forms.mass);
  for (int d = 0; d < dvi_space_dimension(space); d++) add_derivative(space, d, 1, forms.stiffness);
  return forms;
}

void free_space_forms(space_forms *forms)
{
  free(forms->mass);
  free(forms->stiffness);
}

void space_eigenvalues(space_forms *forms, double *lambda)
{
  const int type = 1, size = 64 * forms->n;
  int info = -1;
  double *work = calloc((size_t)size + 1, sizeof *work);
  dsygv_(&type, "N", "L", &forms->n, forms->stiffness, &forms->n, forms->mass, &forms->n, lambda,
         work, &size, &info, 1, 1);
  ck_assert_int_eq(info, 0);
  free(work);
}

int space_eigenvalues_inside(const dvi_space *space, const char *part, double *lambda)
{
  space_forms forms = forms_of_space(space);
  int64_t fixed;
  const int *function = dvi_space_boundary(space, part, &fixed);
  const int n = forms.n;
  int *inner = calloc((size_t)n + 1, sizeof *inner), count = 0;
  for (int i = 0, at = 0; i < n; i++)
    if (at < fixed && function[at] == i)
      at++;
    else
      inner[count++] = i;
  for (int i = 0; i < count; i++)
    for (int j = 0; j < count; j++) {
      forms.mass[i * count + j] = forms.mass[inner[i] * n + inner[j]];
      forms.stiffness[i * count + j] = forms.stiffness[inner[i] * n + inner[j]];
    }
  forms.n = count;
  space_eigenvalues(&forms, lambda);
  free(inner);
  free_space_forms(&forms);
  return count;
}

double interpolation_error(const dvi_space *space,
                           int (*f)(int64_t count, const double *x, double *f, void *user),
                           void *user)
{
  const double *x, *weight;
  const int64_t points = dvi_space_points(space, &x, &weight);
  const int value[DVI_AXES_MAX] = {0};
  double *U = malloc((size_t)dvi_space_functions(space) * sizeof *U), error = 0,
         *u = malloc((size_t)points * sizeof *u), *exact = malloc((size_t)points * sizeof *exact);
  ck_assert_msg(dvi_space_interpolate(space, f, user, U) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_space_apply(space, value, U, u) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(f(points, x, exact, user), 0);
  for (int64_t k = 0; k < points; k++) error += weight[k] * (u[k] - exact[k]) * (u[k] - exact[k]);
  free(U);
  free(u);
  free(exact);
  return sqrt(error);
}
