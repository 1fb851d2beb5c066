/** The codes that are run beside the methods, which are those of SUNDIALS and bare loops. */
#ifndef PEER_H
#define PEER_H
#include <stdbool.h>

#include "cli/options.h"
#include "problem.h"

enum { PEERS_MAX = 16 };

/** A selection of peers by their numbers. */
typedef struct peer_list {
  int count;
  int peer[PEERS_MAX];
  bool bare; /**< bare loops beside methods of the same steps (bare.h) */
} peer_list;

/** Return the name of a peer, 0 to PEERS_MAX-1, in tables, or NULL beyond the last one. */
const char *peer_name(int peer);

/** Read names such as "cvode,bare", each once. The part before a name's dash is enough. Returns
 * DONE, or complains and returns USAGE. */
int peers_read(const words *against, peer_list *list);

/** Integrate a problem from its start to t_end. q and p [n] are set to the start, and then hold the
 * end. After a failure they hold the start.
 *
 *  @param[out] report  steps and evaluations, may be NULL
 *  @return the status and sentence of dvi_reference_solve */
dvi_status peer_solve(int peer, const problem *scene, double t_end, double tolerance, double *q,
                      double *p, dvi_reference_report *report);
#endif
