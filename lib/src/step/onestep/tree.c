/* A Runge-Kutta method has an order if it satisfies one condition for each rooted tree.
 *
 *     sum_i b_i g_i(root) = 1 / product over all vertices of the number of vertices above or at it,
 *     g_i(vertex) = product over its children of sum_j a_ij g_j(child)
 *
 * Trees are listed by the levels of their vertices, from the tallest to the bush (Beyer and
 * Hedetniemi 1980). */
#include <math.h>
#include <stdio.h>

#include "step/onestep/runge_kutta.h"
#include "core/status.h"

enum { TEXT = 4 * DVI__TREES_MOST };

/* levels[0] = 0 is the root. The children of a vertex are the vertices of the next level that
 * follow. */
typedef struct tree {
  int order;
  int level[DVI__TREES_MOST];
} tree;

/* Advance to the next tree of this order. Returns 0 after the last one. */
static int tree_next(tree *t)
{
  int p = t->order - 1;
  while (p > 0 && t->level[p] == 1) p--;
  if (p == 0) return 0;
  int parent = p - 1;
  while (t->level[parent] != t->level[p] - 1) parent--;
  for (int i = p; i < t->order; i++) t->level[i] = t->level[i - (p - parent)];
  return 1;
}

/* Compute g of the vertex at `at`. Returns the first vertex behind its subtree, and multiplies
 * *density by the sizes. */
static int tree_weigh(const dvi__runge_kutta *m, const tree *t, int at, double *g, double *density)
{
  double of_child[DVI__RK_STAGES_MOST];
  int end = at + 1;
  for (int i = 0; i < m->stages; i++) g[i] = 1;
  while (end < t->order && t->level[end] > t->level[at]) {
    end = tree_weigh(m, t, end, of_child, density);
    for (int i = 0; i < m->stages; i++) {
      double sum = 0;
      for (int j = 0; j < m->stages; j++) sum += m->a[i][j] * of_child[j];
      g[i] *= sum;
    }
  }
  *density *= end - at;
  return end;
}

/* Write each vertex as a bracket around its children. */
static void tree_draw(const tree *t, char text[TEXT])
{
  int length = 0;
  for (int i = 0; i < t->order; i++) {
    const int closed = i + 1 < t->order ? t->level[i] - t->level[i + 1] + 1 : t->level[i] + 1;
    text[length++] = '[';
    for (int k = 0; k < closed; k++) text[length++] = ']';
  }
  text[length] = 0;
}

/* Coefficients may be given as decimals with the digits of a double, and have this rounding. */
static const double rounding = 1e-12;

/* Suggest a cause for a sum with a small error. */
static const char *tree_hint(double off)
{
  return fabs(off) < 1e-3
             ? ", to 1e-12; are the decimals cut off? fractions and 15 digits are exact enough"
             : "";
}

static dvi_status check_tree(const dvi__runge_kutta *m, const tree *t)
{
  double g[DVI__RK_STAGES_MOST], density = 1, sum = 0, size = 0;
  (void)tree_weigh(m, t, 0, g, &density);
  for (int i = 0; i < m->stages; i++) {
    sum += m->b[i] * g[i];
    size += fabs(m->b[i] * g[i]);
  }
  if (fabs(sum - 1 / density) <= rounding * (1 + size)) return DVI_OK;
  char text[TEXT];
  tree_draw(t, text);
  return dvi__fail(DVI_BAD_OPTION,
                   "the tableau has not order %d: the sum of its condition for the tree %s is "
                   "%.15g, not %s%.0f%s",
                   t->order, text, sum, density > 1 ? "1/" : "", density,
                   tree_hint(sum - 1 / density));
}

dvi_status dvi__runge_kutta_check(const dvi__runge_kutta *method, int order)
{
  for (int i = 0; i < method->stages; i++) {
    double sum = 0;
    for (int j = 0; j < method->stages; j++) sum += method->a[i][j];
    if (!(fabs(sum - method->c[i]) <= rounding * (1 + fabs(sum))))
      return dvi__fail(DVI_BAD_OPTION,
                       "the tableau's row %d of a has the sum %.15g, but c is %.15g there%s", i + 1,
                       sum, method->c[i], tree_hint(sum - method->c[i]));
  }
  for (int n = 1; n <= order && n <= DVI__TREES_MOST; n++) {
    tree t = {.order = n};
    for (int i = 0; i < n; i++) t.level[i] = i;
    do DVI_TRY(check_tree(method, &t));
    while (tree_next(&t));
  }
  return DVI_OK;
}
