/* Rotations of R^n and their lifts to Spin(n), n from 2 to 4.
 *
 *     n = 2: (cos a/2, sin a/2).    n = 3: a unit quaternion q, v -> q v q^-1.
 *     n = 4: two unit quaternions p and q, v -> p v q^-1 with the quaternion v. */
#ifndef DVI_FIELD_CONNECTION_SPIN_H
#define DVI_FIELD_CONNECTION_SPIN_H

enum { DVI__SPIN_MAX = 8, DVI__ROTATION_MAX = 16 };

/* Give the number of components of a lift. */
int dvi__spin_size(int n);

/* Set the identity, products c = a b, where c is neither of both, and inverses. */
void dvi__rotation_one(int n, double *R);
void dvi__rotation_times(int n, const double *a, const double *b, double *c);
void dvi__rotation_inverse(int n, const double *a, double *inverse);
void dvi__spin_one(int n, double *s);
void dvi__spin_times(int n, const double *a, const double *b, double *c);
void dvi__spin_inverse(int n, const double *a, double *inverse);

/* Give the size of the largest entry of R R^T - 1. */
double dvi__rotation_defect(int n, const double *R);

/* Give one of the two lifts of a rotation. */
void dvi__spin_of(int n, const double *R, double *lift);

/* A plane with an orientation, by two orthonormal vectors. */
typedef struct dvi__plane {
  double first[4], second[4];
} dvi__plane;

/* Give the turn of a plane by an angle from the first to the second vector, and its lift. */
void dvi__rotation_turn(int n, const dvi__plane *plane, double angle, double *R);
void dvi__spin_turn(int n, const dvi__plane *plane, double angle, double *lift);

/* Give the angle of the turn that is nearest to a rotation, in [-pi, pi], and to a lift, in
 * [-2 pi, 2 pi]. */
double dvi__rotation_angle(int n, const dvi__plane *plane, const double *R);
double dvi__spin_angle(int n, const dvi__plane *plane, const double *lift);

#endif
