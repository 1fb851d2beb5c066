/* Byte code for some nodes of a graph. A program is a straight line of operations on rows of lanes.
 *
 * Lanes are points, or elements of a sum, or both. Every operation is one loop over lanes, which
 * the compiler makes vectors of. The bits of a lane do not depend on how many lanes there are, nor
 * on the instruction set. Rows of numbers that are no longer needed are used again. */
#ifndef DVI_EXPR_COMPILE_PROGRAM_H
#define DVI_EXPR_COMPILE_PROGRAM_H
#include "expr/graph.h"

enum {
  /* A row consists of blocks of so many lanes. Its last lanes may be idle, but hold numbers. */
  DVI__LANES = 8,
  DVI__LONG_BLOCK = 64, /* lanes of which whole blocks go faster */
  DVI__LANES_MAX = 256, /* lanes of a row */
  DVI__ROWS_MAX = 16384 /* inputs, registers and outputs of a program */
};

/* The members to, a, b, c are rows. A row is the number of a register, or ~i for input i. */
typedef struct dvi__instruction {
  int op; /* a dvi__op, or one of enum dvi__code */
  int to, a, b, c;
  double value;
} dvi__instruction;

/* The caller owns a program and frees it by dvi__program_free. Outputs are the registers from
 * row_count - output_count on. */
typedef struct dvi__program {
  int instruction_count, row_count, input_count, output_count;
  dvi__instruction *instruction;
} dvi__program;

/* Compile a program. The nodes input[input_count], all different, are read and not computed. Every
 * INPUT that a root depends on is below one of them. root[k] becomes output k. DVI_BAD_ARGUMENT if
 * an INPUT is not below one, DVI_BAD_SIZE beyond DVI__ROWS_MAX, DVI_NO_MEMORY. */
dvi_status dvi__program_make(const dvi__graph *graph, int input_count, const dvi__node *input,
                             int root_count, const dvi__node *root, dvi__program *program);
void dvi__program_free(dvi__program *program);

/* Return how many operations a lane takes. Loads and stores do not count. */
int dvi__program_operations(const dvi__program *program);

/* Return the lanes of a row with `lanes` of them in use. */
static inline int dvi__row_width(int lanes)
{
  return (lanes + DVI__LANES - 1) / DVI__LANES * DVI__LANES;
}

/* Run a program on 1 to DVI__LANES_MAX lanes. input[i] is a row [dvi__row_width(lanes)]. registers
 * has row_count rows. */
void dvi__program_run(const dvi__program *program, int lanes, const double *const *input,
                      double *registers);

/* Run a program on one block of lanes at most. Input i stands below the registers, at
 * registers - (i+1) DVI__LANES, so that finding a row takes no decision. */
void dvi__program_run_block(const dvi__program *program, int lanes, double *registers);

/* Run a program on truncated power series of a degree up to DVI_TAYLOR_MAX. A row has degree + 1
 * coefficients, and input i is at registers - (i+1) (degree+1). */
void dvi__program_run_series(const dvi__program *program, int degree, double *registers);

#endif
