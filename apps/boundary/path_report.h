/** The report on a path that was found, and the file of its nodes. */
#ifndef PATH_REPORT_H
#define PATH_REPORT_H
#include <stdio.h>

#include "boundary/path_family.h"

void print_report(const member *m, const path_request *request, FILE *stream);

/** Write the nodes, with their momenta and invariants, to a CSV file, or to standard output if its
 * name is "-". Returns DONE, or complains and returns the exit code. */
int write_path(const member *m, const char *out);
#endif
