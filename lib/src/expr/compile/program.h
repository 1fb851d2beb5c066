/* Byte code for some nodes of a graph: straight lines of operations on rows of lanes.
 *
 * Lanes are points, or elements of a sum, or both; every operation is one loop over lanes, which
 * the compiler makes vectors of. The bits of a lane do not depend on how many lanes there are, nor
 * on the instruction set. Rows of numbers that are no longer needed are taken again. */
#ifndef DVI_EXPR_PROGRAM_H
#define DVI_EXPR_PROGRAM_H
#include "expr/graph.h"

enum {
  DVI__LANES = 8, /* rows are made of whole blocks of so many lanes; the last lanes may be idle, but
                     hold numbers */
  DVI__LANES_MAX = 256, /* of a row */
  DVI__ROWS_MAX = 16384 /* inputs, registers and outputs of a program: more is refused */
};

/* to, a, b, c are rows: a register, or ~i for input i. */
typedef struct dvi__instruction {
  int op; /* a dvi__op, or one of the program's own */
  int to, a, b, c;
  double value;
} dvi__instruction;

/* Owned by whoever made it; dvi__program_free. Registers row_count - output_count and following are
 * the outputs. */
typedef struct dvi__program {
  int instruction_count, row_count, input_count, output_count;
  dvi__instruction *instruction;
} dvi__program;

/* Compile. The nodes input[input_count], all different, are given, and nothing is computed for
 * them; every INPUT that a root depends on is below one of them. root[k] becomes output k.
 * DVI_BAD_ARGUMENT if an input is not given, DVI_BAD_SIZE beyond DVI__ROWS_MAX, DVI_NO_MEMORY. */
dvi_status dvi__program_make(const dvi__graph *graph, int input_count, const dvi__node *input,
                             int root_count, const dvi__node *root, dvi__program *program);
void dvi__program_free(dvi__program *program);

/* How many operations a lane takes, loads and stores not counted. */
int dvi__program_operations(const dvi__program *program);

/* Lanes of a row with `lanes` of them in use. */
static inline int dvi__row_width(int lanes)
{
  return (lanes + DVI__LANES - 1) / DVI__LANES * DVI__LANES;
}

/* Run on 1 to DVI__LANES_MAX lanes. input[i]: rows [dvi__row_width(lanes)]; registers: row_count
 * rows. */
void dvi__program_run(const dvi__program *program, int lanes, const double *const *input,
                      double *registers);

/* The same for one block of lanes at most, with input i below the registers, at registers - (i+1)
 * DVI__LANES: then where a row is takes no decision. */
void dvi__program_run_block(const dvi__program *program, int lanes, double *registers);

/* Run on truncated power series of a degree up to DVI_TAYLOR_MAX: rows are of degree + 1
 * coefficients, input i at registers - (i+1) (degree+1). */
void dvi__program_run_series(const dvi__program *program, int degree, double *registers);

#endif
