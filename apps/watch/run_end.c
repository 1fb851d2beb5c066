#include "watch/run_end.h"

#include <errno.h>
#include <string.h>

#include "cli/command.h"

const char run_ended_again[] =
    "dvi: run: a second Ctrl-C ended the run at once; FILEs not yet complete stay as they were\n";

bool run_file_is_good(const whole_file *file)
{
  if (!ferror(file->stream)) return true;
  if (file->path != NULL) complain("cannot write '%s': %s", file->path, strerror(errno));
  return false;
}

int run_interrupted(const run_request *request, int signal, double t)
{
  complain("run: signal %d ended the run at t = %.17g of %g; the output is complete up to there",
           signal, t, request->t_end);
  if (request->checkpoint != NULL) complain("run: continue with --resume %s", request->checkpoint);
  return 128 + signal;
}

bool run_keeps_files(int code)
{
  return code == DONE || code > CHECK_FAILED;
}
