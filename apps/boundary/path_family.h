/** A family of problems over one parameter, whose paths are solved one after the other. */
#ifndef PATH_FAMILY_H
#define PATH_FAMILY_H
#include "boundary/path_request.h"
#include "problem.h"

enum { NAME_SIZE = 64 };

/** A family of problems with values of one parameter. */
typedef struct family {
  char name[NAME_SIZE];
  double first, last;
  long parts; /**< 0 for a single problem */
} family;

/** A member of the family, with its problem and its path. */
typedef struct member {
  problem *scene;
  dvi_path *path;
  dvi_path_report report;
  bool found; /**< the path is stationary and has a report, but its steps may be too long */
} member;

/** Read a family such as "e=0.1:0.9:8". A request without one leaves `f` as it is. Returns DONE, or
 * complains and returns USAGE. */
int read_family(const path_request *request, family *f);

/** Solve for the last member of the family. Returns DONE, or complains and returns the exit code.
 * Destroy `last` in either case. */
int solve_family(const char *name, const path_request *request, const family *f, member *last);

void member_destroy(member *m);
#endif
