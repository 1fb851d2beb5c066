#include "support/quad/quad_simplex.h"

static const int factorial[] = {1, 1, 2, 6, 24};

static quad dot(int count, const quad *a, const quad *b)
{
  quad sum = 0;
  for (int i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

/* Set edge = R axis with triangular R (Gram and Schmidt's, twice is enough). */
static void orthogonalise(quad_simplex *s, quad edge[][QUAD_SPACE], quad R[][QUAD_CORNERS])
{
  for (int i = 0; i < s->k; i++) {
    quad left[QUAD_SPACE];
    for (int l = 0; l < s->space; l++) left[l] = edge[i][l];
    for (int j = 0; j < i; j++) R[i][j] = 0;
    for (int twice = 0; twice < 2; twice++)
      for (int j = 0; j < i; j++) {
        const quad part = dot(s->space, left, s->axis[j]);
        R[i][j] += part;
        for (int l = 0; l < s->space; l++) left[l] -= part * s->axis[j][l];
      }
    R[i][i] = quad_sqrt(dot(s->space, left, left));
    for (int l = 0; l < s->space; l++) s->axis[i][l] = left[l] / R[i][i];
  }
}

/* Solve R x = b. */
static void solve(int k, quad R[][QUAD_CORNERS], const quad *b, quad *x)
{
  for (int i = 0; i < k; i++) x[i] = (b[i] - dot(i, R[i], x)) / R[i][i];
}

void quad_simplex_of(int k, int space, const double *point, const int *corner, quad_simplex *s)
{
  quad edge[QUAD_CORNERS][QUAD_SPACE], R[QUAD_CORNERS][QUAD_CORNERS], half[QUAD_CORNERS],
      centre[QUAD_CORNERS];
  s->k = k;
  s->space = space;
  for (int i = 0; i < k; i++) {
    for (int l = 0; l < space; l++)
      edge[i][l] = (quad)point[corner[i + 1] * space + l] - point[corner[0] * space + l];
    half[i] = dot(space, edge[i], edge[i]) / 2;
  }
  orthogonalise(s, edge, R);
  solve(k, R, half, centre);
  s->volume = 1;
  s->centre[0] = 1;
  for (int j = 0; j < k; j++) s->covector[0][j] = 0;
  for (int i = 0; i < k; i++) {
    quad unit[QUAD_CORNERS] = {0};
    unit[i] = 1;
    solve(k, R, unit, s->covector[i + 1]);
    s->centre[i + 1] = dot(k, s->covector[i + 1], centre);
    s->centre[0] -= s->centre[i + 1];
    for (int j = 0; j < k; j++) s->covector[0][j] -= s->covector[i + 1][j];
    s->volume *= R[i][i] / (i + 1);
  }
}

/* Corners of larger sets have larger masks than those of their subsets. */
void quad_star(int n, int space, const double *point, quad *entry, quad *size)
{
  quad weight[QUAD_FACES] = {0}, sum[QUAD_FACES] = {0};
  const int whole = (1 << (n + 1)) - 1;
  weight[whole] = sum[whole] = 1;
  for (int mask = whole; mask > 0; mask--) {
    int corner[QUAD_CORNERS] = {0}, k = -1;
    quad_simplex s;
    for (int c = 0; c <= n; c++)
      if (mask >> c & 1) corner[++k] = c;
    quad_simplex_of(k, space, point, corner, &s);
    entry[mask] = weight[mask] / factorial[n - k] / s.volume;
    size[mask] = sum[mask] / factorial[n - k] / s.volume;
    for (int i = 0; i <= k && k > 0; i++) {
      const quad step = s.centre[i] / quad_sqrt(dot(k, s.covector[i], s.covector[i]));
      weight[mask & ~(1 << corner[i])] += weight[mask] * step;
      sum[mask & ~(1 << corner[i])] += sum[mask] * quad_abs(step);
    }
  }
}

static quad determinant(int count, quad a[][QUAD_CORNERS])
{
  if (count == 0) return 1;
  quad sum = 0;
  for (int j = 0; j < count; j++) {
    quad rest[QUAD_CORNERS][QUAD_CORNERS];
    for (int row = 1; row < count; row++)
      for (int column = 0, at = 0; column < count; column++)
        if (column != j) rest[row - 1][at++] = a[row][column];
    sum += (j % 2 == 0 ? 1 : -1) * a[0][j] * determinant(count - 1, rest);
  }
  return sum;
}

quad quad_minor(const quad_simplex *s, int count, const int *of, const int *axis)
{
  quad a[QUAD_CORNERS][QUAD_CORNERS];
  for (int i = 0; i < count; i++)
    for (int j = 0; j < count; j++) a[i][j] = s->covector[of[i]][axis[j]];
  return determinant(count, a);
}

static int without(int k, const int *I, int i, int *rest)
{
  int at = 0;
  for (int j = 0; j <= k; j++)
    if (j != i) rest[at++] = I[j];
  return i % 2 == 0 ? 1 : -1;
}

/* Sum over the sets of k axes of the basis. */
static quad product_of_wedges(const quad_simplex *s, int k, const int *a, const int *b)
{
  quad sum = 0;
  for (int mask = 0; mask < 1 << s->k; mask++) {
    int axis[QUAD_CORNERS], count = 0;
    for (int c = 0; c < s->k; c++)
      if (mask >> c & 1) axis[count++] = c;
    if (count == k) sum += quad_minor(s, k, a, axis) * quad_minor(s, k, b, axis);
  }
  return sum;
}

quad quad_whitney(const quad_simplex *s, int k, const int *I, const int *J)
{
  quad sum = 0;
  for (int i = 0; i <= k; i++)
    for (int j = 0; j <= k; j++) {
      int a[QUAD_CORNERS], b[QUAD_CORNERS];
      const int sign = without(k, I, i, a) * without(k, J, j, b);
      sum += sign * (I[i] == J[j] ? 2 : 1) * product_of_wedges(s, k, a, b);
    }
  return factorial[k] * factorial[k] * s->volume * sum / ((s->k + 1) * (s->k + 2));
}

quad quad_whitney_form(const quad_simplex *s, int k, const int *I, const double *place,
                       const int *axes)
{
  quad sum = 0;
  for (int i = 0; i <= k; i++) {
    int rest[QUAD_CORNERS];
    quad a[QUAD_CORNERS][QUAD_CORNERS];
    const int sign = without(k, I, i, rest);
    for (int row = 0; row < k; row++)
      for (int column = 0; column < k; column++) {
        a[row][column] = 0;
        for (int m = 0; m < s->k; m++)
          a[row][column] += s->covector[rest[row]][m] * s->axis[m][axes[column]];
      }
    sum += sign * (quad)place[I[i]] * determinant(k, a);
  }
  return factorial[k] * sum;
}
