#include "support/meshes.h"

#include <math.h>
#include <stdlib.h>

#include "support/suite.h"

double random_number(unsigned long long *state)
{
  *state = *state * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(*state >> 11) / 9007199254740992.0;
}

static dvi_mesh *made_of(dvi_mesh_terms terms, double *point, int *vertex)
{
  dvi_mesh *mesh = NULL;
  terms.size = sizeof terms;
  terms.point = point;
  terms.vertex = vertex;
  ck_assert_msg(dvi_mesh_create(&terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  free(point);
  free(vertex);
  return mesh;
}

/* The next permutation of n numbers in the order of dictionaries. Returns 0 after the last one. */
static int next_permutation(int n, int *p)
{
  int i = n - 2, j = n - 1;
  while (i >= 0 && p[i] > p[i + 1]) i--;
  if (i < 0) return 0;
  while (p[j] < p[i]) j--;
  const int other = p[i];
  p[i] = p[j];
  p[j] = other;
  for (i++, j = n - 1; i < j; i++, j--) {
    const int last = p[i];
    p[i] = p[j];
    p[j] = last;
  }
  return 1;
}

static int power(int base, int exponent)
{
  int result = 1;
  for (int i = 0; i < exponent; i++) result *= base;
  return result;
}

dvi_mesh *jittered_mesh(int n, int space, int cells, double jitter, unsigned long long seed)
{
  const int nodes = cells + 1, points = power(nodes, n), cubes = power(cells, n);
  double *point = calloc((size_t)(points * space), sizeof *point);
  int *vertex = calloc((size_t)(cubes * 24 * (n + 1)), sizeof *vertex), count = 0;
  for (int i = 0; i < points; i++)
    for (int axis = 0, rest = i; axis < n; axis++, rest /= nodes) {
      const int at = rest % nodes, is_inner = at > 0 && at < cells;
      const double move = jitter * (2 * random_number(&seed) - 1);
      point[i * space + axis] = (at + (is_inner ? move : 0)) / cells;
    }
  for (int cube = 0; cube < cubes; cube++) {
    int corner = 0, order[] = {0, 1, 2, 3};
    for (int axis = 0, rest = cube; axis < n; axis++, rest /= cells)
      corner += rest % cells * power(nodes, axis);
    do {
      int at = vertex[count++] = corner;
      for (int i = 0; i < n; i++) at = vertex[count++] = at + power(nodes, order[i]);
    } while (next_permutation(n, order));
  }
  return made_of(
      (dvi_mesh_terms){.dimension = n, .space = space, .points = points, .cells = count / (n + 1)},
      point, vertex);
}

dvi_mesh *random_simplex(int n, int space, const double *metric, unsigned long long seed)
{
  double *point = calloc((size_t)((n + 1) * space), sizeof *point);
  int *vertex = calloc((size_t)(n + 1), sizeof *vertex);
  for (int i = 0; i < (n + 1) * space; i++) point[i] = random_number(&seed);
  for (int i = 0; i <= n; i++) vertex[i] = i;
  return made_of(
      (dvi_mesh_terms){
          .dimension = n, .space = space, .points = n + 1, .cells = 1, .metric = metric},
      point, vertex);
}

/* Even rows have the points i/across, odd ones 0, (i + 1/2)/across, 1. */
dvi_mesh *staggered_mesh(int across, int up)
{
  double *point = calloc((size_t)((across + 2) * (up + 1) * 2), sizeof *point);
  int *vertex = calloc((size_t)(across * up * 9 + 9 * up), sizeof *vertex),
      *first = calloc((size_t)up + 2, sizeof *first), cells = 0;
  for (int j = 0; j <= up; j++) {
    const int odd = j % 2;
    first[j + 1] = first[j] + across + 1 + odd;
    for (int i = 0; i < across + 1 + odd; i++) {
      const double x = odd ? (i - 0.5) / across : (double)i / across;
      point[2 * (first[j] + i)] = x < 0 ? 0 : x > 1 ? 1 : x;
      point[2 * (first[j] + i) + 1] = (double)j / up;
    }
  }
  for (int j = 0; j < up; j++) {
    const int even = first[j + j % 2], odd = first[j + 1 - j % 2];
    for (int i = 0; i <= across; i++) {
      const int lower[] = {even + i, even + i + 1, odd + i + 1},
                upper[] = {odd + i, odd + i + 1, even + i};
      for (int c = 0; c < 3 && i < across; c++) vertex[3 * cells + c] = lower[c];
      cells += i < across;
      for (int c = 0; c < 3; c++) vertex[3 * cells + c] = upper[c];
      cells++;
    }
  }
  const int points = first[up + 1];
  free(first);
  return made_of((dvi_mesh_terms){.dimension = 2, .points = points, .cells = cells}, point, vertex);
}

dvi_mesh *ring_mesh(int points, double jitter, unsigned long long seed)
{
  static const double period = 1;
  double *point = calloc((size_t)points, sizeof *point);
  int *vertex = calloc((size_t)points * 2, sizeof *vertex);
  for (int i = 0; i < points; i++) {
    point[i] = (i + jitter * (2 * random_number(&seed) - 1)) / points;
    vertex[2 * i] = i;
    vertex[2 * i + 1] = (i + 1) % points;
  }
  return made_of(
      (dvi_mesh_terms){.dimension = 1, .points = points, .cells = points, .period = &period}, point,
      vertex);
}

/* Odd rows are shifted to the right by half of a side. */
dvi_mesh *equilateral_torus(int across, int up)
{
  const int points = across * up;
  const double height = sqrt(0.75) / across, period[] = {1, up * height};
  double *point = calloc((size_t)points * 2, sizeof *point);
  int *vertex = calloc((size_t)points * 6, sizeof *vertex), count = 0;
  for (int j = 0; j < up; j++)
    for (int i = 0; i < across; i++) {
      const int odd = j % 2, row = j * across, above = (j + 1) % up * across,
                left = above + (i + odd + across - 1) % across, right = above + (i + odd) % across,
                triangles[] = {row + i, row + (i + 1) % across, right, row + i, right, left};
      point[2 * (row + i)] = (i + 0.5 * odd) / across;
      point[2 * (row + i) + 1] = j * height;
      for (int c = 0; c < 6; c++) vertex[count++] = triangles[c];
    }
  return made_of(
      (dvi_mesh_terms){.dimension = 2, .points = points, .cells = count / 3, .period = period},
      point, vertex);
}
