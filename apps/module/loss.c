#define _XOPEN_SOURCE 700
#include "module/loss.h"

#include <errno.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/file.h"
#include "cli/signals.h"

enum { TEXT_SIZE = 2048, PERIOD = 250000 /* microseconds */ };

/* Memory of all processes of a machine. */
typedef struct seat {
  pid_t pid; /* 0 of one that this process cannot see, as from another container */
  int rank;
} seat;
typedef struct table {
  atomic_int taken; /* not 0 if a process says, or has said, why all end */
  seat seat[];
} table;

static table *common; /* NULL while nobody is looked for */
static int seats, speech_of_own = -1;
static seat *known; /* [seats] */

/* What a process says, whose number is between the two texts. A handler reads the second one while
 * the program writes its next version. */
static const char before[] = "dvi: the process of rank ";
static char text[2][TEXT_SIZE];
static _Atomic(const char *) behind;

/* ---- in a handler ---- */

static void say(const char *words, size_t size)
{
  const ssize_t written = write(STDERR_FILENO, words, size);
  (void)written;
}

static void say_number(int number)
{
  char digits[16];
  size_t first = sizeof digits;
  do {
    digits[--first] = (char)('0' + number % 10);
    number /= 10;
  } while (number > 0);
  say(digits + first, sizeof digits - first);
}

/* Return the rank of a process of this machine that is there no more, or -1. */
static int find_missing(void)
{
  for (int i = 0; i < seats; i++)
    if (known[i].pid != 0 && kill(known[i].pid, 0) != 0 && errno == ESRCH) return known[i].rank;
  return -1;
}

/* End, if another process is missing. */
static void look(void)
{
  const int kept = errno, missing = common != NULL ? find_missing() : -1;
  errno = kept;
  if (missing < 0) return;
  file_remove_unfinished();
  if (loss_may_speak()) {
    const char *words = behind;
    say(before, sizeof before - 1);
    say_number(missing);
    say(words, strlen(words));
  }
  _exit(FAILED);
}

bool loss_may_speak(void)
{
  if (common == NULL) return true;
  if (atomic_exchange(&common->taken, 1) != 0) return false;
  return dup2(speech_of_own, STDERR_FILENO) >= 0;
}

/* ---- in the program ---- */

static void on_alarm(int number)
{
  (void)number;
  look();
}

/* Look four times a second: not all starters end the others when one process is killed. */
static void set_alarm(long period)
{
  const struct itimerval every = {{0, period}, {0, period}};
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_alarm;
  action.sa_flags = (int)SA_RESTART;
  (void)sigaction(SIGALRM, &action, NULL);
  (void)setitimer(ITIMER_REAL, &every, NULL);
}

void loss_remedy(const char *remedy)
{
  char *next = behind == text[0] ? text[1] : text[0];
  const int most = TEXT_SIZE / 2;
  (void)snprintf(next, TEXT_SIZE, " was killed, or has crashed; %.*s\n", most, remedy);
  behind = next;
}

bool loss_watch(const petsc_module *module, int rank, int speech)
{
  int own;
  table *shared = module->share_memory(sizeof *shared, sizeof *shared->seat, &own, &seats);
  if (shared == NULL) return false;
  shared->seat[own] = (seat){.pid = getpid(), .rank = rank};
  known = calloc((size_t)seats, sizeof *known);
  if (!module->wait_for_all() || known == NULL) return false;
  for (int i = 0; i < seats; i++)
    if (i != own && kill(shared->seat[i].pid, 0) == 0) known[i] = shared->seat[i];
  speech_of_own = speech;
  common = shared;
  loss_remedy("there is no checkpoint");
  signals_among(look, loss_may_speak);
  set_alarm(PERIOD);
  return module->wait_for_all();
}

void loss_end(void)
{
  if (common == NULL) return;
  set_alarm(0);
  common = NULL;
  free(known);
}
