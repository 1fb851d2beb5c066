/** What the command line of dvi bench asks for. */
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
  const char *name; /**< of the problem */
  bench_outputs outputs;
  const char *at, *scale, *judged_by;
  double t_end, h; /**< NaN: the problem's */
  long levels;     /**< 0: chosen, and more may follow */
  long rounds;
  long steps; /**< of --scale, 0: its own */
  words methods, transforms, settings, against, axes;
  peer_list peers;
  judge_kind judge;
  bool one_point;
} bench_request;

/** Read it. False if the command is to end now, with *exit_code. */
bool bench_request_read(int argc, char **argv, bench_request *request, int *exit_code);
#endif
