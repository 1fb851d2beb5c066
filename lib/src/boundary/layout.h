/* Enumeration of the entries of the whole Jacobian, used for its pattern and for its values. */
#ifndef DVI_BOUNDARY_LAYOUT_H
#define DVI_BOUNDARY_LAYOUT_H
#include "boundary/path_struct.h"

/* Called for an entry (row, column) that gets `factor` times number `from` of an element's
 * Hessian. */
typedef void dvi__emit(void *of, int row, int column, double factor, size_t from);

/* Emit all entries to which step k contributes. */
void dvi__path_each_entry(const dvi_path *path, int k, dvi__emit *emit, void *of);

/* Emit all pairs of an unknown of a node and a gauge. The factor is the gauge's number `from`. */
typedef void dvi__emit_gauge(void *of, int unknown, int multiplier, size_t from);
void dvi__path_each_gauge(const dvi_path *path, dvi__emit_gauge *emit, void *of);

#endif
