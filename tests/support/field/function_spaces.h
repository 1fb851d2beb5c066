/* Function spaces for tests, and what is computed of them without the library's densities. */
#ifndef TESTS_SUPPORT_FIELD_FUNCTION_SPACES_H
#define TESTS_SUPPORT_FIELD_FUNCTION_SPACES_H
#include <dvi/space.h>

/* Create a space on one axis, or fail the test. */
dvi_space *space_on_line(const char *kind, double from, double to, int periodic);

/* Create a space of one kind on a box [0,length]^axes. */
dvi_space *space_on_box(const char *kind, int axes, double length, int periodic);

/* Create a space on a mesh. */
dvi_space *space_on_mesh(const char *kind, const dvi_mesh *mesh);

/* The mass and the stiffness [n*n], full. */
typedef struct space_forms {
  int n;
  double *mass, *stiffness;
} space_forms;
space_forms forms_of_space(const dvi_space *space);
void free_space_forms(space_forms *forms);

/* Eigenvalues [n] of K x = lambda M x, ascending, by LAPACK. The forms are overwritten. */
void space_eigenvalues(space_forms *forms, double *lambda);

/* The same without the functions of a part of the boundary. Returns their number. */
int space_eigenvalues_inside(const dvi_space *space, const char *part, double *lambda);

/* The error of interpolation in L2, by the quadrature of the space and f at its points. */
double interpolation_error(const dvi_space *space,
                           int (*f)(int64_t count, const double *x, double *f, void *user),
                           void *user);

#endif
