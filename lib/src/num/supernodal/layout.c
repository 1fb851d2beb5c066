/* Which columns make a supernode, and which rows it has. */
#include "num/supernodal/layout.h"

#include "core/memory.h"
#include "core/status.h"

void dvi__elimination_postorder(int n, const int *parent, int *order, int *work)
{
  int *child = work, *sibling = work + n, *stack = work + 2 * n, count = 0;
  for (int k = 0; k < n; k++) child[k] = -1;
  for (int k = n - 1; k >= 0; k--) {
    sibling[k] = parent[k] >= 0 ? child[parent[k]] : -1;
    if (parent[k] >= 0) child[parent[k]] = k;
  }
  for (int root = 0; root < n; root++) {
    int depth = 0;
    if (parent[root] >= 0) continue;
    stack[depth++] = root;
    while (depth > 0) {
      const int top = stack[depth - 1], next = child[top];
      if (next >= 0) {
        child[top] = sibling[next];
        stack[depth++] = next;
      } else {
        order[count++] = top;
        depth--;
      }
    }
  }
}

/* ---- supernodes ---- */

/* Columns first to last. */
typedef struct run {
  int first, last;
} run;

/* Tell whether a supernode of so many columns may have this share of zeros. Small ones may, because
 * each supernode costs some time of its own. */
static int is_worth(int width, double zeros)
{
  enum { ALWAYS = 4, SMALL = 16, MIDDLE = 48 };
  return width <= ALWAYS || zeros <= (width <= SMALL ? 0.4 : width <= MIDDLE ? 0.1 : 0.05);
}

/* Join a supernode and the one before, whose parent it must have. `sum` counts the entries of the
 * columns before each one. */
static int may_join(const dvi__elimination *e, const double *sum, run before, run next)
{
  const double width = next.last - before.first + 1,
               stored = width * (width + 1) / 2 + width * e->length[next.last],
               zeros = stored - (sum[next.last + 1] - sum[before.first]);
  const int parent = e->parent[before.last];
  return parent >= 0 && parent <= next.last && is_worth((int)width, zeros / stored);
}

/* Find the supernodes from the first column on. Returns their number. */
static int find_runs(const dvi__elimination *e, double *sum, run *runs)
{
  int count = 0;
  for (int k = 0; k < e->n; k++) {
    sum[k + 1] = sum[k] + e->length[k] + 1;
    runs[count++] = (run){k, k};
    while (count > 1 && may_join(e, sum, runs[count - 2], runs[count - 1])) {
      runs[count - 2].last = runs[count - 1].last;
      count--;
    }
  }
  return count;
}

/* ---- rows ---- */

/* The lists of rows while they are made. */
typedef struct lists {
  int count;
  run *runs;     /* [n] */
  int *of;       /* [n] supernode of each column */
  size_t *start; /* [n+1] */
  size_t *next;  /* [n] where each list goes on */
  int *flag;     /* [n] last row of each list */
  double *sum;   /* [n+1] */
} lists;

static void clear_lists(lists *l)
{
  dvi__release(l->runs);
  dvi__release(l->of);
  dvi__release(l->start);
  dvi__release(l->flag);
  dvi__release(l->sum);
}

static int new_lists(size_t n, lists *l)
{
  *l = (lists){.runs = DVI_NEW(run, n),
               .of = DVI_NEW(int, n),
               .start = DVI_NEW(size_t, 2 * n + 1),
               .flag = DVI_NEW(int, n),
               .sum = DVI_NEW(double, n + 1)};
  l->next = l->start != NULL ? l->start + n + 1 : NULL;
  return l->runs && l->of && l->start && l->flag && l->sum;
}

/* A supernode begins with its columns. */
static void begin_lists(const dvi__elimination *e, lists *l)
{
  for (int s = 0; s < l->count; s++) {
    const run r = l->runs[s];
    l->start[s + 1] = l->start[s] + (size_t)(r.last - r.first + 1) + (size_t)e->length[r.last];
    for (int k = r.first; k <= r.last; k++) l->of[k] = s;
    l->flag[s] = -1;
  }
}

/* Append row i to the lists of all supernodes that have it. They are on the paths from the
 * matrix's entries of the row to the root. */
static void append_row(const dvi__elimination *e, lists *l, int i, int *rows)
{
  const int column = e->order[i];
  for (int at = e->start[column]; at < e->start[column + 1]; at++) {
    const int k = e->place[e->row[at]];
    if (k >= i) continue;
    for (int s = l->of[k]; s != l->of[i] && l->flag[s] != i;
         s = l->of[e->parent[l->runs[s].last]]) {
      l->flag[s] = i;
      rows[l->next[s]++] = i;
    }
  }
}

static void fill_lists(const dvi__elimination *e, lists *l, int *rows)
{
  for (int s = 0; s < l->count; s++) {
    l->next[s] = l->start[s];
    for (int k = l->runs[s].first; k <= l->runs[s].last; k++) rows[l->next[s]++] = k;
  }
  for (int i = 0; i < e->n; i++) append_row(e, l, i, rows);
}

/* ---- panels ---- */

/* Divide a supernode into panels of equal width or so. Returns their number. */
static int panels_of(run r)
{
  return (r.last - r.first + DVI__PANEL_MOST) / DVI__PANEL_MOST;
}

static void add_panels(dvi__supernodes *s, const lists *l, int supernode)
{
  const run r = l->runs[supernode];
  const int parts = panels_of(r), width = r.last - r.first + 1;
  const int *row = s->rows + l->start[supernode];
  const int height = (int)(l->start[supernode + 1] - l->start[supernode]);
  for (int part = 0; part < parts; part++) {
    const int from = (int)((long)width * part / parts),
              to = (int)((long)width * (part + 1) / parts);
    dvi__panel *p = s->panel + s->panels;
    *p = (dvi__panel){r.first + from, to - from, height - from, row + from, NULL};
    for (int k = 0; k < p->width; k++) s->panel_of[p->first + k] = s->panels;
    s->count += (size_t)p->width * (size_t)p->height;
    if (p->height > s->tallest) s->tallest = p->height;
    s->panels++;
  }
}

static int make_panels(dvi__supernodes *s, const lists *l)
{
  size_t count = 0;
  for (int i = 0; i < l->count; i++) count += (size_t)panels_of(l->runs[i]);
  s->panel = DVI_NEW(dvi__panel, count);
  s->panel_of = DVI_NEW(int, s->of.n);
  if (s->panel == NULL || s->panel_of == NULL) return 0;
  for (int i = 0; i < l->count; i++) add_panels(s, l, i);
  s->numbers = DVI_NEW(double, s->count + DVI__BEHIND);
  double *next = s->numbers;
  for (int i = 0; i < s->panels && next != NULL; i++) {
    s->panel[i].L = next;
    next += (size_t)s->panel[i].width * (size_t)s->panel[i].height;
  }
  return s->numbers != NULL;
}

static int make_all(dvi__supernodes *s, lists *l)
{
  l->count = find_runs(&s->of, l->sum, l->runs);
  begin_lists(&s->of, l);
  s->rows = DVI_NEW(int, l->start[l->count]);
  if (s->rows == NULL) return 0;
  fill_lists(&s->of, l, s->rows);
  return make_panels(s, l);
}

dvi_status dvi__supernodes_lay_out(dvi__supernodes *supernodes)
{
  lists l;
  const int made = new_lists((size_t)supernodes->of.n, &l) && make_all(supernodes, &l);
  clear_lists(&l);
  if (made) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "LDL: no memory for %d columns", supernodes->of.n);
}
