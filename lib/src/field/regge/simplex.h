/* The geometry of a simplex from the lengths of its edges.
 *
 * With barycentric coordinates lambda_i the metric is g = -sum_{i<j} s_ij d lambda_i d lambda_j,
 * s_ij = l_ij^2. The products P_ij = <d lambda_i, d lambda_j> follow from the inverse of the inner
 * products of edges, which are computed in twice the digits, because thin simplices lose theirs.
 * All derivatives are polynomials in P:
 *
 *     dV/ds_ij = -V P_ij/2,    dP_ab/ds_ij = (P_ai P_bj + P_aj P_bi)/2.
 *
 * The dihedral angle theta at the hinge without corners a and b lies between the facets without a
 * and without b. With z_i = x_i + i y_i, the components of d lambda_i in the plane normal to the
 * hinge, x along d lambda_a,
 *
 *     d theta/ds_ij = -(sin theta)/2 Re(e^{i theta} z_i z_j). */
#ifndef DVI_FIELD_REGGE_SIMPLEX_H
#define DVI_FIELD_REGGE_SIMPLEX_H
#include "field/mesh/faces.h"

enum {
  DVI__PAIRS = 10 /* of corners of a 4-simplex: its edges, and its hinges by what they lack */
};

/* A simplex is flat if an edge leaves no more than this part of its square beside the others. Its
 * products then have no digit left, with those of rounded numbers of twice the digits. */
extern const double dvi__flat_part;

/* Give the number of pairs of corners of an n-simplex, and the number of the pair i < j among
 * (0,1), (0,2) .. (n-1,n). */
static inline int dvi__pairs(int n)
{
  return n * (n + 1) / 2;
}

static inline int dvi__pair(int n, int i, int j)
{
  return i * (2 * n + 1 - i) / 2 + j - i - 1;
}

/* Products P of the differentials of barycentric coordinates, and the volume, of a simplex with
 * some corners of another one. The rows of other corners are 0. */
typedef struct dvi__simplex_products {
  double volume;
  double P[DVI__SIMPLEX_CORNERS][DVI__SIMPLEX_CORNERS];
} dvi__simplex_products;

/* A hinge, the face of dimension n - 2 that lacks two corners a < b. */
typedef struct dvi__hinge {
  dvi__simplex_products face; /* its volume is 1 for n = 2, where it is a vertex */
  double angle, sine, cosine; /* of the dihedral angle, 0 < angle < pi */
  double x[DVI__SIMPLEX_CORNERS], y[DVI__SIMPLEX_CORNERS]; /* z_i */
} dvi__hinge;

/* A simplex of dimension 2 to 4. Pairs number its edges, and its hinges by the corners that they
 * lack. */
typedef struct dvi__measured_simplex {
  int n;
  double length[DVI__PAIRS];
  dvi__simplex_products cell;
  dvi__hinge hinge[DVI__PAIRS];
} dvi__measured_simplex;

/* Compute all of a simplex from its lengths [pairs] > 0. Returns 0 if there is no such simplex in
 * Euclidean space, or only a flat one. */
int dvi__simplex_measure(int n, const double *length, dvi__measured_simplex *simplex);

/* Return the set of corners of the face of lowest dimension that does not exist, which is the
 * clearest one to name, or 0 if all do. */
int dvi__missing_face(int n, const double *length);

/* First derivatives [pairs] by the lengths, of the volume, of hinge h and of its angle. */
void dvi__volume_slopes(const dvi__measured_simplex *simplex, double *slope);
void dvi__hinge_slopes(const dvi__measured_simplex *simplex, int h, double *slope);
void dvi__angle_slopes(const dvi__measured_simplex *simplex, int h, double *slope);

/* Second derivatives [pairs*pairs] by the lengths. */
void dvi__volume_bends(const dvi__measured_simplex *simplex, double *bend);
void dvi__hinge_bends(const dvi__measured_simplex *simplex, int h, double *bend);
void dvi__angle_bends(const dvi__measured_simplex *simplex, int h, double *bend);

#endif
