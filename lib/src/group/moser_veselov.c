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
#include "group/moser_veselov.h"

#include <dvi/group.h>
#include <math.h>

#include "group/stumpff.h"
#include "group/turn.h"
#include "group/vector.h"

enum { MOST_ITERATIONS = 60, SWEEPS = 12 };

static const double half_turn = 3.14159265358979323846;

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

/* The coefficients a = 1 + more_a, b, c = least_c + more_c at s, and their derivatives. */
typedef struct coefficients {
  double more_a, b, least_c, more_c, a_s, b_s, c_s;
} coefficients;

static coefficients coefficients_at(dvi__moser_veselov_map by, double s)
{
  double c[9];
  if (by == DVI__BY_CAYLEY)
    return (coefficients){.b = 1, .least_c = 0.5, .more_c = 0.5 * s, .c_s = 0.5};
  dvi__stumpff(s, c);
  return (coefficients){.more_a = -s * c[3],
                        .b = c[2],
                        .least_c = 1,
                        .a_s = 0.5 * (c[3] - c[2]),
                        .b_s = 0.5 * (2 * c[4] - c[3])};
}

/* slant_i f_j f_k */
static void slant_product(const dvi__body *body, const double f[3], double product[3])
{
  for (int i = 0; i < 3; i++) product[i] = body->slant[i] * f[(i + 1) % 3] * f[(i + 2) % 3];
}

/* Guess f by two passes of Cayley's equation, solved for its linear term. The error is of fourth
 * order in the angle. */
static void guess_rotation(const dvi__body *body, dvi__moser_veselov_map by, const double g[3],
                           double f[3])
{
  double product[3];
  for (int i = 0; i < 3; i++) f[i] = 0.5 * g[i];
  for (int pass = 0; pass < 2; pass++) {
    const double c = 0.5 * (1 + dvi__dot(f, f));
    slant_product(body, f, product);
    for (int i = 0; i < 3; i++) f[i] = c * g[i] - product[i];
  }
  const double stretch = 2 / (1 + dvi__dot(f, f) / 3); /* 2 atan(x)/x to the second order */
  for (int i = 0; i < 3 && by == DVI__BY_EXPONENTIAL; i++) f[i] *= stretch;
}

/* Compute the residual of the equation at f. Only c h Pi and J f at f = 0 are rounded to their own
 * size, because small terms are added last. */
static void step_residual(const dvi__body *body, const coefficients *at, const double impulse[3],
                          const double f[3], double r[3])
{
  const double *d = body->second;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double Jf = d[j] * f[i] + d[k] * f[i], product = f[j] * f[k],
                 turned = d[j] * product - d[k] * product;
    r[i] = (at->least_c * impulse[i] - Jf) +
           (at->more_c * impulse[i] - at->more_a * Jf - at->b * turned);
  }
}

/* Compute Newton's correction at f. Return the determinant of the derivative. */
static double newton_correction(const dvi__body *body, dvi__moser_veselov_map by,
                                const double impulse[3], const double f[3], double delta[3])
{
  const coefficients at = coefficients_at(by, dvi__dot(f, f));
  double product[3], r[3], row[3][3], minor[3][3];
  slant_product(body, f, product);
  step_residual(body, &at, impulse, f, r);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double right_side = at.c_s * impulse[i] / body->moment[i];
    const double along = 2 * (at.a_s * f[i] + at.b_s * product[i] - right_side);
    r[i] /= body->moment[i];
    row[i][i] = (1 + at.more_a) + along * f[i];
    row[i][j] = at.b * body->slant[i] * f[k] + along * f[j];
    row[i][k] = at.b * body->slant[i] * f[j] + along * f[k];
  }
  for (int i = 0; i < 3; i++) dvi__cross(row[(i + 1) % 3], row[(i + 2) % 3], minor[i]);
  const double determinant = dvi__dot(row[0], minor[0]);
  for (int i = 0; i < 3; i++)
    delta[i] = (r[0] * minor[0][i] + r[1] * minor[1][i] + r[2] * minor[2][i]) / determinant;
  return determinant;
}

/* Iterate from f to the solution. Return the count of iterations, or 0. An iterate off the branch
 * goes half of the way back. */
static int solve_newton(const dvi__body *body, dvi__moser_veselov_map by, const double impulse[3],
                        double f[3])
{
  const double most = by == DVI__BY_CAYLEY ? HUGE_VAL : half_turn * half_turn;
  double last[3] = {0};
  for (int iteration = 1; iteration <= MOST_ITERATIONS; iteration++) {
    double delta[3];
    const double determinant = newton_correction(body, by, impulse, f, delta),
                 size = sqrt(dvi__dot(f, f));
    const int inside = determinant > 0 && size * size < most;
    for (int i = 0; i < 3; i++) {
      const double here = f[i];
      f[i] = inside ? here + delta[i] : 0.5 * (here + last[i]);
      if (inside) last[i] = here;
    }
    /* The next correction would be about |delta|^2 / determinant. */
    if (inside && dvi__dot(delta, delta) <= 1e-17 * determinant * size) return iteration;
  }
  return 0;
}

static void to_axes(const dvi__body *body, const dvi__turn *turn, const double x[3], double y[3])
{
  double change[3] = {0};
  if (body->turned) dvi__turn_change(turn, x, change);
  for (int i = 0; i < 3; i++) y[i] = x[i] + change[i];
}

int dvi__body_moser_veselov(const dvi__body *body, dvi__moser_veselov_map by,
                            const double impulse[3], double w[3])
{
  double inside[3], g[3], f[3];
  if (!(dvi__dot(impulse, impulse) <= body->largest * body->largest)) return 0;
  to_axes(body, &body->into, impulse, inside);
  for (int i = 0; i < 3; i++) g[i] = inside[i] / body->moment[i];
  guess_rotation(body, by, g, f);
  const int iterations = solve_newton(body, by, inside, f);
  if (iterations != 0 && by == DVI__BY_EXPONENTIAL) dvi__turn_tangent(f, f);
  to_axes(body, &body->out, f, w);
  return iterations;
}

void dvi__body_velocity(const dvi__body *body, const double Pi[3], double Omega[3])
{
  double inside[3];
  to_axes(body, &body->into, Pi, inside);
  for (int i = 0; i < 3; i++) inside[i] /= body->moment[i];
  to_axes(body, &body->out, inside, Omega);
}
