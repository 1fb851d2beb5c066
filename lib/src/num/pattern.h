/* Sparsity patterns by compressed columns. */
#ifndef DVI_NUM_PATTERN_H
#define DVI_NUM_PATTERN_H
#include <dvi/system.h>

/* An owned pattern: column j holds rows row[start[j]] .. row[start[j+1]-1], ascending. */
typedef struct dvi__pattern {
  int rows, columns;
  int *start; /* [columns+1] */
  int *row;   /* [start[columns]] */
} dvi__pattern;

/* Number of entries. */
int dvi__pattern_entries(const dvi__pattern *pattern);

/* Copy a declared n x n pattern, or make the full one if both its arrays are NULL; `name` is for
 * the message. DVI_BAD_ARGUMENT if it is not a pattern, DVI_NO_MEMORY. On failure nothing is
 * owned. */
dvi_status dvi__pattern_copy(const dvi_pattern *declared, int n, const char *name,
                             dvi__pattern *copy);

/* The same of a matrix with other numbers of rows and columns. */
dvi_status dvi__pattern_copy_rectangular(const dvi_pattern *declared, int rows, int columns,
                                         const char *name, dvi__pattern *copy);

/* The same for a Hessian: DVI_BAD_ARGUMENT also if it is not symmetric. One triangle alone would
 * leave out half of the entries of a step's Jacobian. */
dvi_status dvi__pattern_copy_symmetric(const dvi_pattern *declared, int n, const char *name,
                                       dvi__pattern *copy);

/* The pattern of an n x n matrix without entries. */
dvi_status dvi__pattern_empty(int n, dvi__pattern *pattern);

/* The pattern of the n x n identity. */
dvi_status dvi__pattern_diagonal(int n, dvi__pattern *pattern);

/* The union of two patterns of one size. `sum` may not alias either. */
dvi_status dvi__pattern_union(const dvi__pattern *a, const dvi__pattern *b, dvi__pattern *sum);

/* The transposed pattern. */
dvi_status dvi__pattern_transpose(const dvi__pattern *pattern, dvi__pattern *transpose);

/* Every entry becomes a full size x size block: entry (i,j) the rows i*size+k and columns j*size+l.
 * DVI_BAD_SIZE if an int cannot count the entries. */
dvi_status dvi__pattern_blocks(const dvi__pattern *pattern, int size, dvi__pattern *blocks);

/* The same of a square pattern with blocks of several sizes: entry (i,j) becomes the rows first[i]
 * .. first[i+1]-1 and columns first[j] .. first[j+1]-1; first [columns+1]. */
dvi_status dvi__pattern_uneven_blocks(const dvi__pattern *pattern, const int *first,
                                      dvi__pattern *blocks);

/* Index of entry (row, column), or -1. */
int dvi__pattern_find(const dvi__pattern *pattern, int row, int column);

/* where[e] = index in `whole` of entry e of `part`, which must be a subset; where has room for
 * part's entries. */
void dvi__pattern_embed(const dvi__pattern *part, const dvi__pattern *whole, int *where);

/* Greedy column groups with no common row in a group (Curtis, Powell and Reid 1974): group[j] in
 * 0..*groups-1. */
dvi_status dvi__pattern_groups(const dvi__pattern *pattern, int *group, int *groups);

/* Additions and multiplications of an LU factorisation of a square pattern, at most, by diagonal
 * pivots in the given order: of a band, or of a full matrix. */
double dvi__pattern_operations(const dvi__pattern *pattern);

/* Free the arrays and zero the struct. */
void dvi__pattern_clear(dvi__pattern *pattern);

#endif
