#include "watch/run_end.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "module/ranks.h"

enum { TEXT_SIZE = 1024 };

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

/* Tell how to go on without a checkpoint of this run. */
static void start_again(const run_request *request, char *text, size_t size)
{
  if (request->resume != NULL)
    (void)snprintf(text, size, "go on with --resume %s, as this run did", request->resume);
  else
    (void)snprintf(text, size, "%s",
                   request->checkpoint != NULL
                       ? "there is no checkpoint yet: start again"
                       : "there is no checkpoint: start again, with --checkpoint FILE "
                         "--checkpoint-every K");
}

void run_tell_checkpoint(const run_request *request, const double *saved, const double *next)
{
  char text[TEXT_SIZE], otherwise[TEXT_SIZE / 2] = "";
  const char *path = request->checkpoint;
  if (saved == NULL) start_again(request, otherwise, sizeof otherwise);
  if (saved != NULL && next != NULL)
    (void)snprintf(text, sizeof text, "go on with --resume %s, which stands at t = %.17g or %.17g",
                   path, *saved, *next);
  else if (saved != NULL)
    (void)snprintf(text, sizeof text, "go on with --resume %s, which stands at t = %.17g", path,
                   *saved);
  else if (next != NULL)
    (void)snprintf(
        text, sizeof text,
        "the first checkpoint was being written: if '%s' stands at t = %.17g, go on with "
        "--resume %s; otherwise %s",
        path, *next, path, otherwise);
  else
    (void)snprintf(text, sizeof text, "%s", otherwise);
  ranks_remedy(text);
}

bool run_keeps_files(int code)
{
  return code == DONE || code > CHECK_FAILED;
}
