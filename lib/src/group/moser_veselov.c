/* In principal axes, with F = I + a f^ + b f^^2, the equation is
 *
 *     a f_i + b slant_i f_j f_k = c g_i,     g_i = h Pi_i / J_i.
 *
 * The exponential has a = c_1(s), b = c_2(s), c = 1, and Cayley's map a = b = 1, c = (1 + s)/2,
 * with s = |f|^2. The factor c keeps the equation simple.
 *
 * Slants are differences of second moments, so nothing cancels, however thin a body is, and all
 * rows have the size of the angle. But rounded moments and slants do not belong to one body, and
 * axes rounded entry by entry are not orthogonal. Solutions would gain or lose the same energy in
 * every step. Hence the axes are stored as a rotation, and residuals use the second moments
 * themselves,
 *
 *     c h Pi_i - a (d_j f_i + d_k f_i) - b (d_j f_j f_k - d_k f_j f_k).
 *
 * The determinant of the derivative is 1 at f = 0 and vanishes where the branch ends. Iterates stay
 * where it is positive. If J = j I then g = sin(a) n, and the branch ends at a quarter turn. No F
 * has |h Pi| above the largest moment, because h Pi.n = tr(F Jd n^^T) is at most the sum of the
 * singular values of Jd n^. */
#include <dvi/group.h>
#include <math.h>

#include "group/moser_veselov_core.h"

enum { SWEEPS = 12 };

/* ---- principal axes ---- */

/* Apply one of Jacobi's rotations, which makes A_pq zero. The columns of the axes are rotated
 * too. */
static void jacobi_rotate(double A[3][3], double axis[3][3], int p, int q)
{
  const double theta = (A[q][q] - A[p][p]) / (2 * A[p][q]),
               t = copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1)),
               cosine = 1 / sqrt(t * t + 1), sine = t * cosine;
  for (int k = 0; k < 3; k++) {
    const double Akp = A[k][p], Akq = A[k][q];
    A[k][p] = cosine * Akp - sine * Akq;
    A[k][q] = sine * Akp + cosine * Akq;
  }
  for (int k = 0; k < 3; k++) {
    const double Apk = A[p][k], Aqk = A[q][k], up = axis[p][k], uq = axis[q][k];
    A[p][k] = cosine * Apk - sine * Aqk;
    A[q][k] = sine * Apk + cosine * Aqk;
    axis[p][k] = cosine * up - sine * uq;
    axis[q][k] = sine * up + cosine * uq;
  }
  A[p][q] = A[q][p] = 0;
}

/* Find the rotation of rows into the axes, or into the axes with two of them reversed. Of these
 * four it has the smallest angle, at most 2 pi/3. */
static dvi__turn turn_into(double axis[3][3])
{
  double columns[9], q[4] = {1}, w[3];
  int m = 0;
  for (int i = 0; i < 9; i++) columns[i] = axis[i % 3][i / 3];
  (void)dvi_so3_quaternion(columns, q);
  for (int i = 1; i < 4; i++)
    if (fabs(q[i]) > fabs(q[m])) m = i;
  /* A half turn about e after the turn of q has the quaternion (-q.e, q_0 e + q x e). */
  const double e[3] = {m == 1, m == 2, m == 3};
  dvi__cross(q + 1, e, w);
  for (int i = 0; i < 3; i++) w[i] = m == 0 ? q[1 + i] / q[0] : -(w[i] + q[0] * e[i]) / q[m];
  return dvi__turn_of(w);
}

static void find_axes(double A[3][3], dvi__body *body)
{
  double axis[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int sweep = 0; sweep < SWEEPS; sweep++)
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++)
        if (A[p][q] != 0) {
          jacobi_rotate(A, axis, p, q);
          body->turned = 1;
        }
  body->into = turn_into(axis);
  body->out = dvi__turn_back(&body->into);
}

int dvi__body_of(const double Jd[9], dvi__body *body)
{
  double A[3][3] = {{Jd[0], Jd[1], Jd[2]}, {Jd[3], Jd[4], Jd[5]}, {Jd[6], Jd[7], Jd[8]}};
  *body = (dvi__body){.turned = 0};
  find_axes(A, body);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    body->second[i] = A[i][i];
    body->moment[i] = A[j][j] + A[k][k];
    body->slant[i] = (A[j][j] - A[k][k]) / body->moment[i];
    body->largest = fmax(body->largest, body->moment[i]);
  }
  return body->moment[0] > 0 && body->moment[1] > 0 && body->moment[2] > 0;
}

/* ---- Newton's method ---- */

/* Iterate from f to the solution. Return the count of iterations, or 0. */
static int solve_newton(const dvi__body *body, dvi__moser_veselov_map by, const double impulse[3],
                        double f[3])
{
  double last[3] = {0};
  for (int iteration = 1; iteration <= DVI__BODY_ITERATIONS; iteration++)
    if (dvi__body_iterate(body, by, impulse, f, last)) return iteration;
  return 0;
}

int dvi__body_moser_veselov(const dvi__body *body, dvi__moser_veselov_map by,
                            const double impulse[3], double w[3])
{
  double inside[3], f[3];
  if (!dvi__body_begin(body, by, impulse, inside, f)) return 0;
  const int iterations = solve_newton(body, by, inside, f);
  if (iterations != 0 && by == DVI__BY_EXPONENTIAL) dvi__turn_tangent(f, f);
  dvi__body_turn(body, &body->out, f, w);
  return iterations;
}

void dvi__body_velocity(const dvi__body *body, const double Pi[3], double Omega[3])
{
  double inside[3];
  dvi__body_turn(body, &body->into, Pi, inside);
  for (int i = 0; i < 3; i++) inside[i] /= body->moment[i];
  dvi__body_turn(body, &body->out, inside, Omega);
}
