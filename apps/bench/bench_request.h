/** The request of dvi bench's command line. */
#ifndef BENCH_REQUEST_H
#define BENCH_REQUEST_H
#include <stdbool.h>

#include "bench/bench_report.h"
#include "mechanics/judge.h"
#include "cli/options.h"
#include "bench/peer.h"

enum { STEPS_MAX = 1000000 };

/** The options, read and checked as far as they can be without the problem. */
typedef struct bench_request {
  const char *name; /**< name of the problem */
  bench_outputs outputs;
  const char *at, *scale, *judged_by;
  const char *weak;          /**< of --scale ranks= */
  double latency, bandwidth; /**< of --scale ranks=, NaN if not given */
  double t_end, h;           /**< NaN for the problem's values */
  long levels;               /**< 0 for a choice, which more levels may follow */
  long rounds;
  long steps; /**< steps of --scale, 0 for its own */
  words methods, transforms, settings, against, axes;
  peer_list peers;
  judge_kind judge;
  bool one_point;
} bench_request;

/** Read the request. Returns false if the command is to end now with *exit_code. */
bool bench_request_read(int argc, char **argv, bench_request *request, int *exit_code);
#endif
