/* Sparsity patterns by compressed columns. */
#ifndef DVI_NUM_PATTERN_H
#define DVI_NUM_PATTERN_H
#include <dvi/system.h>

/* An owned pattern. Column j holds rows row[start[j]] .. row[start[j+1]-1], ascending. */
typedef struct dvi__pattern {
  int rows, columns;
  int *start; /* [columns+1] */
  int *row;   /* [start[columns]] */
} dvi__pattern;

/* Give the number of entries. */
int dvi__pattern_entries(const dvi__pattern *pattern);

/* Copy a declared n x n pattern, or make the full one if both its arrays are NULL. `name` is for
 * the message. DVI_BAD_ARGUMENT if it is not a pattern, DVI_NO_MEMORY. On failure nothing is
 * owned. */
dvi_status dvi__pattern_copy(const dvi_pattern *declared, int n, const char *name,
                             dvi__pattern *copy);

/* Copy the pattern of a matrix whose numbers of rows and columns differ. */
dvi_status dvi__pattern_copy_rectangular(const dvi_pattern *declared, int rows, int columns,
                                         const char *name, dvi__pattern *copy);

/* Copy the pattern of a Hessian. DVI_BAD_ARGUMENT also if it is not symmetric. One triangle alone
 * would leave out half of the entries of a step's Jacobian. */
dvi_status dvi__pattern_copy_symmetric(const dvi_pattern *declared, int n, const char *name,
                                       dvi__pattern *copy);

/* Make the pattern of an n x n matrix without entries. */
dvi_status dvi__pattern_empty(int n, dvi__pattern *pattern);

/* Make the pattern of the n x n identity. */
dvi_status dvi__pattern_diagonal(int n, dvi__pattern *pattern);

/* Make the union of two patterns of one size. `sum` may not alias either. */
dvi_status dvi__pattern_union(const dvi__pattern *a, const dvi__pattern *b, dvi__pattern *sum);

/* Make the transposed pattern. */
dvi_status dvi__pattern_transpose(const dvi__pattern *pattern, dvi__pattern *transpose);

/* Expand every entry to a full size x size block. Entry (i,j) becomes the rows i*size+k and columns
 * j*size+l. DVI_BAD_SIZE if an int cannot count the entries. */
dvi_status dvi__pattern_blocks(const dvi__pattern *pattern, int size, dvi__pattern *blocks);

/* Expand the entries of a square pattern to blocks of several sizes. Entry (i,j) becomes the rows
 * first[i] .. first[i+1]-1 and columns first[j] .. first[j+1]-1, with first [columns+1]. */
dvi_status dvi__pattern_uneven_blocks(const dvi__pattern *pattern, const int *first,
                                      dvi__pattern *blocks);

/* Give the index of entry (row, column), or -1. */
int dvi__pattern_find(const dvi__pattern *pattern, int row, int column);

/* Set where[e] to the index in `whole` of entry e of `part`, which must be a subset. `where` has
 * room for the entries of `part`. */
void dvi__pattern_embed(const dvi__pattern *part, const dvi__pattern *whole, int *where);

/* Group columns with no common row greedily (Curtis, Powell and Reid 1974). group[j] is in
 * 0..*groups-1. */
dvi_status dvi__pattern_groups(const dvi__pattern *pattern, int *group, int *groups);

/* Bound the additions and multiplications of an LU factorisation of a square pattern by diagonal
 * pivots in the given order. The bound is that of a band or of a full matrix. */
double dvi__pattern_operations(const dvi__pattern *pattern);

/* Free the arrays and zero the struct. */
void dvi__pattern_clear(dvi__pattern *pattern);

#endif
