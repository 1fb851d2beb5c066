/* Simplices in quadruple precision, from orthogonal coordinates of their edges. */
#ifndef SUPPORT_QUAD_SIMPLEX_H
#define SUPPORT_QUAD_SIMPLEX_H
#include "support/quad/quad_real.h"

enum { QUAD_CORNERS = 5, QUAD_SPACE = 5, QUAD_FACES = 1 << QUAD_CORNERS };

typedef struct quad_simplex {
  int k, space;
  quad axis[QUAD_CORNERS][QUAD_SPACE];       /* an orthonormal basis along the edges */
  quad covector[QUAD_CORNERS][QUAD_CORNERS]; /* d lambda_i in this basis */
  quad volume, centre[QUAD_CORNERS];         /* barycentric coordinates of the circumcentre */
} quad_simplex;

/* Compute the simplex of these corners out of points [..*space], in Euclidean space. */
void quad_simplex_of(int k, int space, const double *point, const int *corner, quad_simplex *s);

/* Set entry and size, by the bits of the corners, to the entries of the circumcentric star of one
 * n-simplex and to the sums of their terms' absolute values. */
void quad_star(int n, int space, const double *point, quad *entry, quad *size);

/* Give the determinant of `count` covectors in the axes [count] of the basis. */
quad quad_minor(const quad_simplex *s, int count, const int *of, const int *axis);

/* Give the entry of Whitney's star for two k-faces with these corners. */
quad quad_whitney(const quad_simplex *s, int k, const int *I, const int *J);

/* Give a component, at axes [k] of space, of Whitney's form of a k-face at a place. */
quad quad_whitney_form(const quad_simplex *s, int k, const int *I, const double *place,
                       const int *axes);

#endif
