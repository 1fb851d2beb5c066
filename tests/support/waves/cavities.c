#include "support/waves/cavities.h"

#include <stdlib.h>

#include "support/waves/bessel.h"

/* Orders, zeros of each, and half waves that the lists draw from, which name far more frequencies
 * than anyone asks for. */
enum { ORDERS = 12, ROOTS = 8, HALF_WAVES = 10, MODES = 4 * ORDERS * ROOTS * (HALF_WAVES + 1) };

typedef struct mode_list {
  int count;
  double frequency[MODES];
} mode_list;

static void add_modes(mode_list *list, quad square, int modes)
{
  for (int i = 0; i < modes && list->count < MODES; i++)
    list->frequency[list->count++] = (double)quad_sqrt(square);
}

static int compare_numbers(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void give_lowest(mode_list *list, int count, double *frequency)
{
  qsort(list->frequency, (size_t)list->count, sizeof *list->frequency, compare_numbers);
  for (int i = 0; i < count; i++) frequency[i] = list->frequency[i];
}

/* ---- the box ---- */

/* A mode has two polarizations, or one if a wave number is zero, and none if two are. */
void cavity_box(const double side[3], int count, double *frequency)
{
  mode_list list = {0};
  const quad pi = quad_acos(-1);
  for (int i = 0; i <= HALF_WAVES; i++)
    for (int j = 0; j <= HALF_WAVES; j++)
      for (int k = 0; k <= HALF_WAVES; k++) {
        const quad x = pi * i / side[0], y = pi * j / side[1], z = pi * k / side[2];
        const int zeros = (i == 0) + (j == 0) + (k == 0);
        add_modes(&list, x * x + y * y + z * z, zeros < 2 ? 2 - zeros : 0);
      }
  give_lowest(&list, count, frequency);
}

/* ---- round ones ---- */

static quad value_of_j(quad x, const void *user)
{
  const int order = *(const int *)user;
  quad_complex J[ORDERS + 1];
  bessel_j(order, qc(x, 0), J);
  return J[order].re;
}

static quad slope_of_j(quad x, const void *user)
{
  const int order = *(const int *)user;
  quad_complex J[ORDERS + 2];
  bessel_j(order + 1, qc(x, 0), J);
  return bessel_slope(J, order).re;
}

static quad value_of_spherical(quad x, const void *user)
{
  const int order = *(const int *)user;
  quad_complex j[ORDERS + 1];
  spherical_j(order, qc(x, 0), j);
  return j[order].re;
}

/* (x j_n)' = x j_{n-1} - n j_n. */
static quad slope_of_riccati(quad x, const void *user)
{
  const int order = *(const int *)user;
  quad_complex j[ORDERS + 1];
  spherical_j(order, qc(x, 0), j);
  return x * j[order - 1].re - order * j[order].re;
}

/* Zeros of one function are more than 2 apart. x = 0 is none of those that count. */
static void roots_of(root_function *f, int order, quad *root)
{
  find_roots(f, &order, 0.25, 0.5, ROOTS, root);
}

/* Add the modes whose cross-section has the frequencies `root`/radius. */
static void add_waves(mode_list *list, const quad *root, quad radius, quad length, int least,
                      int modes)
{
  const quad pi = quad_acos(-1);
  for (int i = 0; i < ROOTS; i++)
    for (int p = least; p <= HALF_WAVES; p++) {
      const quad across = root[i] / radius, along = pi * p / length;
      add_modes(list, across * across + along * along, modes);
    }
}

void cavity_cylinder(double radius, double length, int count, double *frequency)
{
  mode_list list = {0};
  quad root[ROOTS];
  for (int m = 0; m < ORDERS; m++) {
    roots_of(value_of_j, m, root);
    add_waves(&list, root, radius, length, 0, m == 0 ? 1 : 2);
    roots_of(slope_of_j, m, root);
    add_waves(&list, root, radius, length, 1, m == 0 ? 1 : 2);
  }
  give_lowest(&list, count, frequency);
}

static void add_round(mode_list *list, const quad *root, quad radius, int modes)
{
  for (int i = 0; i < ROOTS; i++) add_modes(list, (root[i] / radius) * (root[i] / radius), modes);
}

void cavity_sphere(double radius, int count, double *frequency)
{
  mode_list list = {0};
  quad root[ROOTS];
  for (int n = 1; n < ORDERS; n++) {
    roots_of(value_of_spherical, n, root);
    add_round(&list, root, radius, 2 * n + 1);
    roots_of(slope_of_riccati, n, root);
    add_round(&list, root, radius, 2 * n + 1);
  }
  give_lowest(&list, count, frequency);
}

void cavity_disk(double radius, int count, double *frequency)
{
  mode_list list = {0};
  quad root[ROOTS];
  for (int m = 0; m < ORDERS; m++) {
    roots_of(value_of_j, m, root);
    add_round(&list, root, radius, m == 0 ? 1 : 2);
  }
  give_lowest(&list, count, frequency);
}
