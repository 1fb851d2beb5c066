/* Spaces of one dimension. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/field/function_spaces.h"
#include "support/suite.h"

enum { CELLS = 24, MOST = 400 };

static double largest_eigenvalue(const char *form, int degree)
{
  char kind[80];
  double lambda[MOST];
  (void)snprintf(kind, sizeof kind, form, degree, CELLS);
  dvi_space *space = space_on_line(kind, 0, CELLS, 1);
  space_forms forms = forms_of_space(space);
  space_eigenvalues(&forms, lambda);
  const double largest = lambda[forms.n - 1];
  free_space_forms(&forms);
  dvi_space_destroy(&space);
  return largest;
}

static void check_largest(const char *form, int count, const int *degree, const double *exact,
                          double tolerance)
{
  for (int i = 0; i < count; i++) {
    const double found = largest_eigenvalue(form, degree[i]);
    ck_assert_msg(fabs(found - exact[i]) <= tolerance * exact[i], "degree %d: %.12g, not %.12g",
                  degree[i], found, exact[i]);
  }
}

START_TEST(the_largest_eigenvalues_of_consistent_elements)
{
  const int degree[] = {1, 2, 3, 4, 5, 6, 8};
  const double exact[] = {12, 60, 170.1249025, 380.2351315, 738.9049, 1304.603, 3339.446};
  check_largest("fem:degree=%d,cells=%d", 7, degree, exact, 2e-7);
}
END_TEST

START_TEST(the_largest_eigenvalues_of_lumped_elements)
{
  const int degree[] = {1, 2, 3, 4, 5, 6, 8};
  const double exact[] = {4, 24, 74.3109888, 183.3484833, 391.9589, 749.5576, 2154.992};
  check_largest("fem:degree=%d,cells=%d,lumped=yes", 7, degree, exact, 2e-7);
}
END_TEST

START_TEST(the_largest_eigenvalues_of_splines)
{
  const int degree[] = {1, 2, 3, 4, 5};
  const double exact[] = {12, 10, 9.88235294, 9.87096774, 9.86975398};
  check_largest("spline:degree=%d,cells=%d", 5, degree, exact, 1e-9);
}
END_TEST

SUITE(space_lines)
{
  tcase_add_test(tests, the_largest_eigenvalues_of_consistent_elements);
  tcase_add_test(tests, the_largest_eigenvalues_of_lumped_elements);
  tcase_add_test(tests, the_largest_eigenvalues_of_splines);
}
