/** The codes that are run beside the methods: those of SUNDIALS, and GSL's rk8pd in a build that
 * has it. */
#ifndef PEER_H
#define PEER_H
#include "cli/options.h"
#include "problem.h"

enum { PEERS_MAX = 16 };

/** Some of them, by their numbers. */
typedef struct peer_list {
  int count;
  int peer[PEERS_MAX];
} peer_list;

/** The name of a peer, 0 to PEERS_MAX-1, in tables; NULL beyond the last one. */
const char *peer_name(int peer);

/** Read "cvode,ida": names, or what stands before a name's dash, each once. Returns DONE, or
 * complains and returns USAGE. */
int peers_read(const words *against, peer_list *list);

/** Integrate a problem from its start, put into q and p [n], to t_end. They hold the end then;
 * unchanged on failure.
 *
 *  @param[out] report  steps and evaluations; may be NULL
 *  @return as dvi_reference_solve; peer_error() has the reason */
dvi_status peer_solve(int peer, const problem *scene, double t_end, double tolerance, double *q,
                      double *p, dvi_reference_report *report);

/** Why the last peer_solve failed. */
const char *peer_error(void);

/** The version of GSL; NULL in a build without it. */
const char *peer_gsl_version(void);
#endif
