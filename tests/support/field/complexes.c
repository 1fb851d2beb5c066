#include "support/field/complexes.h"

#include <math.h>
#include <string.h>

#include "support/suite.h"

enum { CELLS = 36, VERTICES = 9, FAN = 64 };

static dvi_mesh *create(const dvi_mesh_terms *terms)
{
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_create(terms, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

/* Make the simplices whose vertices are the digits of words. Unit vectors are the points, as far as
 * there is room: the last of nine is (x, x, ..) at the same distance. */
static dvi_mesh *of_digits(int n, int points, const char *const *word, int cells)
{
  const int space = points < VERTICES ? points : VERTICES - 1;
  int vertex[CELLS * 5];
  double point[VERTICES * (VERTICES - 1)] = {0};
  for (int i = 0; i < points; i++)
    for (int l = 0; l < space; l++) point[i * space + l] = i == space ? 0.5 : i == l;
  for (int c = 0; c < cells; c++)
    for (int i = 0; i <= n; i++) vertex[c * (n + 1) + i] = word[c][i] - '0';
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = n,
                                .space = space,
                                .points = points,
                                .point = point,
                                .cells = cells,
                                .vertex = vertex};
  return create(&terms);
}

dvi_mesh *projective_plane(void)
{
  static const char *const word[] = {"012", "023", "034", "045", "015",
                                     "124", "235", "134", "245", "135"};
  return of_digits(2, 6, word, 10);
}

dvi_mesh *complex_projective_plane(void)
{
  static const char *const word[CELLS] = {
      "01236", "01238", "01246", "01247", "01257", "01258", "01368", "01456", "01457",
      "01568", "02346", "02348", "02478", "02578", "03456", "03457", "03478", "03567",
      "03678", "05678", "12357", "12358", "12367", "12467", "13457", "13458", "13478",
      "13678", "14568", "14678", "23456", "23458", "23567", "24568", "24678", "25678"};
  return of_digits(4, VERTICES, word, CELLS);
}

dvi_mesh *fan_mesh(int count, double *length)
{
  double point[2 * (FAN + 1)] = {0};
  int vertex[3 * FAN];
  for (int i = 0; i < count; i++) {
    const double angle = 2 * 3.14159265358979323846 * i / count;
    point[2 * i + 2] = cos(angle);
    point[2 * i + 3] = sin(angle);
    vertex[3 * i] = 0;
    vertex[3 * i + 1] = 1 + i;
    vertex[3 * i + 2] = 1 + (i + 1) % count;
  }
  for (int e = 0; e < 2 * count && length != NULL; e++) length[e] = 1;
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .dimension = 2,
                                .points = count + 1,
                                .point = point,
                                .cells = count,
                                .vertex = vertex};
  return create(&terms);
}
