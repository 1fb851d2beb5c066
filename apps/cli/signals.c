#define _POSIX_C_SOURCE 200809L
#include "cli/signals.h"

#include <stdatomic.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>

#include "cli/file.h"

_Static_assert(ATOMIC_POINTER_LOCK_FREE == 2,
               "a signal handler reads a pointer that the program writes");

static volatile sig_atomic_t noting, noted;
static _Atomic(const char *) farewell;

/* Of a process among others, otherwise NULL. Set once. */
static void (*look_at_others)(void);
static bool (*is_speaker)(void);

static void on_signal(int number)
{
  if (look_at_others != NULL) look_at_others();
  if (noting && (noted == 0 || number != SIGINT)) {
    if (noted == 0) noted = number;
    return;
  }
  file_remove_unfinished();
  const char *sentence = farewell;
  const bool speaks = sentence != NULL && (is_speaker == NULL || is_speaker());
  const ssize_t written = speaks ? write(STDERR_FILENO, sentence, strlen(sentence)) : 0;
  (void)written;
  _exit(128 + number);
}

static void catch_signal(int number, bool even_ignored)
{
  struct sigaction action;
  if (sigaction(number, NULL, &action) != 0 || (!even_ignored && action.sa_handler == SIG_IGN))
    return;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_signal;
  action.sa_flags = (int)SA_RESTART; /* a row that waits for a slow reader must not be lost */
  (void)sigaction(number, &action, NULL);
}

void signals_end(bool even_ignored, const char *sentence)
{
  farewell = sentence;
  catch_signal(SIGINT, even_ignored);
  catch_signal(SIGTERM, even_ignored);
  catch_signal(SIGHUP, false);
}

const volatile sig_atomic_t *signals_note(const char *sentence)
{
  noting = 1; /* set first, because the sentence is for signals after the noted one */
  farewell = sentence;
  return &noted;
}

void signals_among(void (*look)(void), bool (*may_speak)(void))
{
  is_speaker = may_speak;
  look_at_others = look;
}
