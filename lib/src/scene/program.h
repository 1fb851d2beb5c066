/* Byte code for some nodes of a graph: straight lines of operations on registers, each of them a row of lanes.
 *
 * Lanes are points, or elements of a sum, or both; every operation is one loop over lanes, which the compiler makes vectors of. The bits of a lane do not
 * depend on how many lanes there are. Registers are taken again after their last use. */
#ifndef DVI_SCENE_PROGRAM_H
#define DVI_SCENE_PROGRAM_H
#include "scene/graph.h"

enum {
  DVI__LANES_MAX = 256,        /* of a row */
  DVI__REGISTERS_MAX = 131072, /* of numbers, at least one lane each: more is refused */
};

typedef struct dvi__instruction {
  unsigned short op; /* a dvi__op, or one of the program's own for constants as operands */
  int to, a, b;      /* registers; a is the number of an input or of an output where that is meant */
  double value;
} dvi__instruction;

/* Owned by whoever made it; dvi__program_free. */
typedef struct dvi__program {
  int instruction_count, register_count, input_count, output_count;
  dvi__instruction *instruction;
} dvi__program;

/* Compile. Inputs 0 .. input_count-1 of the graph are read from rows, roots are written to rows. */
dvi_status dvi__program_make(const dvi__graph *graph, int input_count, int root_count, const dvi__node *root,
                             dvi__program *program);
void dvi__program_free(dvi__program *program);

/* How many operations a lane takes, loads and stores not counted. */
int dvi__program_operations(const dvi__program *program);

/* Run on `lanes` lanes, at most DVI__LANES_MAX: input[i] and output[k] are rows [lanes] (outputs may not overlap inputs); `registers` has room for
 * register_count * lanes numbers. */
void dvi__program_run(const dvi__program *program, int lanes, const double *const *input, double *const *output, double *registers);

#endif
