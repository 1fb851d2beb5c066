/* A plane wave of light meets a cylinder of glass, with E along its axis: the exact solution, to
 * compare computed fields with. The wave exp(ikx) is the sum of i^n J_n(kr) exp(in phi). Outside of
 * the cylinder b_n H_n(kr) is added, inside are c_n J_n(mkr), and field and slope are continuous at
 * the surface (Bohren and Huffman 1983, sec. 8.4). */
#include <complex.h>
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

/* Set H to J_0(x) + i Y_0(x) .., with Y_0 by Neumann's series, Y_1 from the Wronskian, and the
 * others by the recurrence upwards. */
static void hankel(double x, const double *J, double complex *H)
{
  double Y[ORDERS + 1] = {2 / pi * (log(x / 2) + 0.57721566490153286061) * J[0]};
  for (int n = 1; 2 * n <= ORDERS; n++) Y[0] -= (n % 2 == 0 ? 4 : -4) / pi * J[2 * n] / n;
  Y[1] = (J[1] * Y[0] - 2 / (pi * x)) / J[0];
  for (int n = 1; n < ORDERS; n++) Y[n + 1] = 2 * n / x * Y[n] - Y[n - 1];
  for (int n = 0; n <= ORDERS; n++) H[n] = J[n] + (double complex)I * Y[n];
}

/* The derivative of function n of the list f. */
static double complex slope(const double complex *f, int n)
{
  return n == 0 ? -f[1] : (f[n - 1] - f[n + 1]) / 2;
}

/* Set f to J_0(x) .., and H, if it is asked for. */
static void waves(double x, double complex *f, double complex *H)
{
  double J[ORDERS + 1];
  bessel_j(x, J);
  if (H != NULL) hankel(x, J, H);
  for (int n = 0; n <= ORDERS; n++) f[n] = J[n];
}

/* Set the amplitudes b of the waves outside, and c of those inside. Returns the number of orders
 * that matter. */
static int match(double complex *b, double complex *c)
{
  const double x = k * radius;
  const int orders = (int)(x + 20);
  double complex J[ORDERS + 1], H[ORDERS + 1], M[ORDERS + 1];
  waves(x, J, H);
  waves(m * x, M, NULL);
  for (int n = 0; n < orders; n++) {
    b[n] = (slope(J, n) * M[n] - m * J[n] * slope(M, n)) /
           (m * H[n] * slope(M, n) - slope(H, n) * M[n]);
    c[n] = (J[n] + b[n] * H[n]) / M[n];
  }
  return orders;
}

static double complex field(int orders, const double complex *b, const double complex *c, double x,
                            double y)
{
  const double r = hypot(x, y), phi = atan2(y, x);
  double complex J[ORDERS + 1], H[ORDERS + 1], sum = 0, power = 1; /* i^n */
  waves(r < radius ? m * k * r : k * r, J, H);
  for (int n = 0; n < orders; n++, power *= (double complex)I)
    sum += (n == 0 ? 1 : 2) * cos(n * phi) * power *
           (r < radius ? c[n] * J[n] : J[n] + b[n] * H[n]);
  return sum;
}

int main(void)
{
  static const double place[][2] = {{-0.7, 0}, {0.2, 0.1}, {0.7, 0}};
  static const char *const name[] = {"front", "inside", "behind"};
  double complex b[ORDERS], c[ORDERS];
  const int orders = match(b, c);
  double scattered = 0;
  for (int i = 0; i < 3; i++)
    printf("%-9s %.6f\n", name[i], cabs(field(orders, b, c, place[i][0], place[i][1])));
  for (int n = 0; n < orders; n++) scattered += (n == 0 ? 1 : 2) * creal(b[n] * conj(b[n]));
  printf("scattered %.6f\n", 2 / k * scattered); /* the mean power, of 1/2 in a unit of width */
  return isfinite(scattered) ? 0 : 1;
}
