/* A plane wave of light meets a cylinder of glass, with E along its axis: the exact solution, to
 * compare computed fields with. The wave exp(ikx) is the sum of i^n J_n(kr) exp(in phi). Outside of
 * the cylinder b_n H_n(kr) is added, inside are c_n J_n(mkr), and field and slope are continuous at
 * the surface (Bohren and Huffman 1983, sec. 8.4). */
#include <math.h>
#include <stdio.h>

enum { ORDERS = 40, START = 120 };

static const double pi = 3.14159265358979323846;
static const double k = 5, radius = 0.5, m = 1.5; /* wave number, and refractive index */

/* Set J to J_0(x) .. by the recurrence downwards, which is stable. J_0 + 2 J_2 + 2 J_4 .. is 1. */
static void bessel_j(double x, double *J)
{
  double above = 0, here = 1e-300, sum = 0;
  for (int n = START; n >= 0; n--) {
    const double below = 2 * (n + 1) / x * here - above;
    above = here;
    here = below;
    if (n <= ORDERS) J[n] = here;
    if (n % 2 == 0) sum += (n == 0 ? 1 : 2) * here;
  }
  for (int n = 0; n <= ORDERS; n++) J[n] /= sum;
}

/* Set Y to Y_0(x) .., of H = J + iY, with Y_0 by Neumann's series, Y_1 from the Wronskian, and the
 * others by the recurrence upwards. */
static void bessel_y(double x, const double *J, double *Y)
{
  Y[0] = 2 / pi * (log(x / 2) + 0.57721566490153286061) * J[0];
  for (int n = 1; 2 * n <= ORDERS; n++) Y[0] -= (n % 2 == 0 ? 4 : -4) / pi * J[2 * n] / n;
  Y[1] = (J[1] * Y[0] - 2 / (pi * x)) / J[0];
  for (int n = 1; n < ORDERS; n++) Y[n + 1] = 2 * n / x * Y[n] - Y[n - 1];
}

/* The derivative of function n of the list f. */
static double slope(const double *f, int n)
{
  return n == 0 ? -f[1] : (f[n - 1] - f[n + 1]) / 2;
}

/* A complex number. */
typedef struct amplitude {
  double re, im;
} amplitude;

/* Set the amplitudes b of the waves outside, and c of those inside. Returns the number of orders
 * that matter. */
static int match(amplitude *b, amplitude *c)
{
  const double x = k * radius;
  const int orders = (int)(x + 20);
  double J[ORDERS + 1] = {0}, Y[ORDERS + 1] = {0}, M[ORDERS + 1] = {0};
  bessel_j(x, J);
  bessel_y(x, J, Y);
  bessel_j(m * x, M);
  for (int n = 0; n < orders; n++) {
    const double wanted = slope(J, n) * M[n] - m * J[n] * slope(M, n),
                 re = m * J[n] * slope(M, n) - slope(J, n) * M[n],
                 im = m * Y[n] * slope(M, n) - slope(Y, n) * M[n], square = re * re + im * im;
    b[n].re = wanted * re / square;
    b[n].im = -wanted * im / square;
    c[n].re = (J[n] + b[n].re * J[n] - b[n].im * Y[n]) / M[n];
    c[n].im = (b[n].re * Y[n] + b[n].im * J[n]) / M[n];
  }
  return orders;
}

/* The size of the field at a place. */
static double field(int orders, const amplitude *b, const amplitude *c, double x, double y)
{
  static const amplitude power[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}}; /* i^n */
  const double r = hypot(x, y), phi = atan2(y, x);
  double J[ORDERS + 1], Y[ORDERS + 1] = {0}, re = 0, im = 0;
  bessel_j(r < radius ? m * k * r : k * r, J);
  if (r >= radius) bessel_y(k * r, J, Y);
  for (int n = 0; n < orders; n++) {
    const amplitude i = power[n % 4];
    const double weight = (n == 0 ? 1 : 2) * cos(n * phi),
                 a = r < radius ? c[n].re * J[n] : J[n] + b[n].re * J[n] - b[n].im * Y[n],
                 d = r < radius ? c[n].im * J[n] : b[n].re * Y[n] + b[n].im * J[n];
    re += weight * (i.re * a - i.im * d);
    im += weight * (i.re * d + i.im * a);
  }
  return hypot(re, im);
}

int main(void)
{
  static const double place[][2] = {{-0.7, 0}, {0.2, 0.1}, {0.7, 0}};
  static const char *const name[] = {"front", "inside", "behind"};
  amplitude b[ORDERS], c[ORDERS];
  const int orders = match(b, c);
  double scattered = 0;
  for (int i = 0; i < 3; i++)
    printf("%-9s %.6f\n", name[i], field(orders, b, c, place[i][0], place[i][1]));
  for (int n = 0; n < orders; n++)
    scattered += (n == 0 ? 1 : 2) * (b[n].re * b[n].re + b[n].im * b[n].im);
  printf("scattered %.6f\n", 2 / k * scattered); /* the mean power, of 1/2 in a unit of width */
  return isfinite(scattered) ? 0 : 1;
}
