#include "field/connection/spin.h"

#include <dvi/group.h>
#include <math.h>
#include <string.h>

static double dot(int n, const double *a, const double *b)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* ---- quaternions ---- */

static void times(const double *a, const double *b, double *c)
{
  c[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
  c[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
  c[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
  c[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

static void conjugate(const double *a, double *c)
{
  c[0] = a[0];
  for (int i = 1; i < 4; i++) c[i] = -a[i];
}

/* ---- the groups ---- */

int dvi__spin_size(int n)
{
  return 1 << (n - 1);
}

void dvi__rotation_one(int n, double *R)
{
  for (int i = 0; i < n * n; i++) R[i] = i % (n + 1) == 0;
}

void dvi__rotation_times(int n, const double *a, const double *b, double *c)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double sum = 0;
      for (int k = 0; k < n; k++) sum += a[i * n + k] * b[k * n + j];
      c[i * n + j] = sum;
    }
}

void dvi__rotation_inverse(int n, const double *a, double *inverse)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) inverse[i * n + j] = a[j * n + i];
}

double dvi__rotation_defect(int n, const double *R)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j <= i; j++) {
      const double defect = fabs(dot(n, R + i * n, R + j * n) - (i == j));
      if (!(defect <= most)) most = defect; /* NaN stays */
      if (isnan(most)) return most;
    }
  return most;
}

void dvi__spin_one(int n, double *s)
{
  memset(s, 0, (size_t)dvi__spin_size(n) * sizeof *s);
  s[0] = 1;
  if (n == 4) s[4] = 1;
}

void dvi__spin_times(int n, const double *a, const double *b, double *c)
{
  if (n == 2) {
    c[0] = a[0] * b[0] - a[1] * b[1];
    c[1] = a[0] * b[1] + a[1] * b[0];
    return;
  }
  times(a, b, c);
  if (n == 4) times(a + 4, b + 4, c + 4);
}

void dvi__spin_inverse(int n, const double *a, double *inverse)
{
  for (int i = 0; i < dvi__spin_size(n); i++) inverse[i] = i % 4 == 0 ? a[i] : -a[i];
}

/* ---- lifts ---- */

/* Row a of the table is 4 p_a q, because v -> p v q^-1 has the matrix sum_ab p_a q_b E_a E_b^-1
 * with v -> e_a v e_b^-1, and these sixteen matrices are orthogonal to each other. The longest row
 * gives q, and the table then p. */
static void lift_pair(const double *R, double *lift)
{
  double table[4][4], most = 0;
  int longest = 0;
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) {
      const double e[2][4] = {{a == 0, a == 1, a == 2, a == 3},
                              {b == 0, -(b == 1), -(b == 2), -(b == 3)}};
      table[a][b] = 0;
      for (int j = 0; j < 4; j++) {
        const double unit[4] = {j == 0, j == 1, j == 2, j == 3};
        double half[4], image[4];
        times(e[0], unit, half);
        times(half, e[1], image);
        for (int i = 0; i < 4; i++) table[a][b] += image[i] * R[4 * i + j] / 4;
      }
    }
  for (int a = 0; a < 4; a++) {
    const double square = dot(4, table[a], table[a]);
    if (square <= most) continue;
    most = square;
    longest = a;
  }
  for (int b = 0; b < 4; b++) lift[4 + b] = table[longest][b] / sqrt(most);
  for (int a = 0; a < 4; a++) lift[a] = dot(4, table[a], lift + 4);
  const double size = sqrt(dot(4, lift, lift));
  for (int a = 0; a < 4; a++) lift[a] /= size;
}

void dvi__spin_of(int n, const double *R, double *lift)
{
  dvi__spin_one(n, lift);
  if (n == 2) {
    const double half = 0.5 * atan2(R[2], R[0]);
    lift[0] = cos(half);
    lift[1] = sin(half);
  } else if (n == 3) {
    (void)dvi_so3_quaternion(R, lift);
  } else {
    lift_pair(R, lift);
  }
}

/* ---- turns of a plane ---- */

void dvi__rotation_turn(int n, const dvi__plane *plane, double angle, double *R)
{
  const double *a = plane->first, *b = plane->second, sine = sin(angle),
               versine = 2 * sin(angle / 2) * sin(angle / 2);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      R[i * n + j] = (i == j) - versine * (a[i] * a[j] + b[i] * b[j]) +
                     sine * (b[i] * a[j] - a[i] * b[j]);
}

/* Give what multiplies the sine of half the angle: for n = 2 the sign of the plane, for n = 3 its
 * normal, for n = 4 the imaginary quaternions b a^-1 and a^-1 b, the second of which with the
 * opposite sign. */
static void set_generator(int n, const dvi__plane *plane, double *g)
{
  const double *a = plane->first, *b = plane->second;
  memset(g, 0, (size_t)dvi__spin_size(n) * sizeof *g);
  if (n == 2) {
    g[1] = a[0] * b[1] - a[1] * b[0];
  } else if (n == 3) {
    g[1] = a[1] * b[2] - a[2] * b[1];
    g[2] = a[2] * b[0] - a[0] * b[2];
    g[3] = a[0] * b[1] - a[1] * b[0];
  } else {
    double inverse[4];
    conjugate(a, inverse);
    times(b, inverse, g);
    times(inverse, b, g + 4);
    g[0] = g[4] = 0;
    for (int i = 5; i < 8; i++) g[i] = -g[i];
  }
}

void dvi__spin_turn(int n, const dvi__plane *plane, double angle, double *lift)
{
  double generator[DVI__SPIN_MAX];
  dvi__spin_one(n, lift);
  set_generator(n, plane, generator);
  for (int i = 0; i < dvi__spin_size(n); i++)
    lift[i] = cos(angle / 2) * lift[i] + sin(angle / 2) * generator[i];
}

double dvi__rotation_angle(int n, const dvi__plane *plane, const double *R)
{
  double first[4], second[4];
  for (int i = 0; i < n; i++) {
    first[i] = dot(n, R + i * n, plane->first);
    second[i] = dot(n, R + i * n, plane->second);
  }
  return atan2(dot(n, plane->second, first) - dot(n, plane->first, second),
               dot(n, plane->first, first) + dot(n, plane->second, second));
}

double dvi__spin_angle(int n, const dvi__plane *plane, const double *lift)
{
  double generator[DVI__SPIN_MAX], one[DVI__SPIN_MAX];
  const int size = dvi__spin_size(n);
  dvi__spin_one(n, one);
  set_generator(n, plane, generator);
  return 2 * atan2(dot(size, generator, lift), dot(size, one, lift));
}
