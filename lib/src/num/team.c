#define _XOPEN_SOURCE 700 /* pthread_sigmask */
#include "num/team.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <time.h>

#include "core/memory.h"
#include "core/status.h"

/* Looks at the work before a thread sleeps. A thread shall not sleep between two steps that follow
 * each other, because waking it takes longer than this many looks. The last of them are tens of
 * microseconds apart. A thread that yields instead, beside other programs, loses a whole slice of
 * time with each look. */
enum { LOOKS = 1000, LOOKS_BEFORE_DOZING = 400 };

/* Portions of shared items for each member, many enough that all end together, few enough that
 * taking them costs nothing. */
enum { PORTIONS = 8 };

typedef struct member {
  dvi__team *team;
  int number;
  pthread_t thread;
} member;

struct dvi__team {
  int started; /* number of threads */
  member *members;
  pthread_mutex_t lock;
  pthread_cond_t begin, end;
  /* The work, which is written under the lock before `turn` changes. */
  void (*work)(void *user, int number);
  void *user;
  int count;
  atomic_ulong turn;
  atomic_int busy; /* threads that have not ended their turn */
};

void dvi__team_pause(int waited)
{
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
  if (waited > LOOKS_BEFORE_DOZING) (void)nanosleep(&(struct timespec){.tv_nsec = 1000}, NULL);
}

static void team_await_turn(dvi__team *team, unsigned long seen)
{
  for (int i = 0; i < LOOKS && atomic_load(&team->turn) == seen; i++) dvi__team_pause(i);
  (void)pthread_mutex_lock(&team->lock);
  while (atomic_load(&team->turn) == seen) (void)pthread_cond_wait(&team->begin, &team->lock);
  (void)pthread_mutex_unlock(&team->lock);
}

/* End a thread's turn. The last thread wakes the caller, which may sleep. */
static void team_end_turn(dvi__team *team)
{
  if (atomic_fetch_sub(&team->busy, 1) != 1) return;
  (void)pthread_mutex_lock(&team->lock);
  (void)pthread_cond_signal(&team->end);
  (void)pthread_mutex_unlock(&team->lock);
}

/* Serve turns. A turn without work is the last. */
static void *team_serve(void *argument)
{
  const member *self = argument;
  dvi__team *team = self->team;
  for (unsigned long turn = 0;; turn++) {
    team_await_turn(team, turn);
    if (team->work == NULL) return NULL;
    if (self->number < team->count) team->work(team->user, self->number);
    team_end_turn(team);
  }
}

static void team_begin_turn(dvi__team *team, int count, void (*work)(void *user, int member),
                            void *user)
{
  (void)pthread_mutex_lock(&team->lock);
  team->work = work;
  team->user = user;
  team->count = count;
  atomic_store(&team->busy, team->started);
  atomic_fetch_add(&team->turn, 1);
  (void)pthread_cond_broadcast(&team->begin);
  (void)pthread_mutex_unlock(&team->lock);
}

void dvi__team_run(dvi__team *team, int count, void (*work)(void *user, int member), void *user)
{
  team_begin_turn(team, count, work, user);
  work(user, 0);
  for (int i = 0; i < LOOKS && atomic_load(&team->busy) > 0; i++) dvi__team_pause(i);
  (void)pthread_mutex_lock(&team->lock);
  while (atomic_load(&team->busy) > 0) (void)pthread_cond_wait(&team->end, &team->lock);
  (void)pthread_mutex_unlock(&team->lock);
}

typedef struct shared {
  void (*work)(void *user, int member, int item);
  void *user;
  int count, portion; /* items that a member takes at once */
  atomic_int next;
} shared;

static void team_take_items(void *user, int number)
{
  shared *items = user;
  for (;;) {
    const int first = atomic_fetch_add(&items->next, items->portion);
    if (first >= items->count) return;
    for (int i = first; i < items->count && i - first < items->portion; i++)
      items->work(items->user, number, i);
  }
}

void dvi__team_share(dvi__team *team, int count, void (*work)(void *user, int member, int item),
                     void *user)
{
  const int size = team->started + 1;
  shared items = {
      .work = work, .user = user, .count = count, .portion = count / (PORTIONS * size) + 1};
  dvi__team_run(team, size, team_take_items, &items);
}

/* Start the threads with all signals blocked. The program's signals are for its own threads. */
static void team_start_threads(dvi__team *team, int size)
{
  sigset_t all, before;
  (void)sigfillset(&all);
  (void)pthread_sigmask(SIG_SETMASK, &all, &before);
  for (int i = 1; i < size; i++) {
    member *next = &team->members[i];
    *next = (member){.team = team, .number = i};
    if (pthread_create(&next->thread, NULL, team_serve, next) != 0) break;
    team->started++;
  }
  (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
}

dvi_status dvi__team_create(int size, dvi__team **team)
{
  *team = NULL;
  dvi__team *made = DVI_NEW(dvi__team, 1);
  member *members = DVI_NEW(member, size);
  if (made == NULL || members == NULL) {
    dvi__release(made);
    dvi__release(members);
    return dvi__fail(DVI_NO_MEMORY, "threads: no memory for %d", size);
  }
  made->members = members;
  /* with default attributes none of the three can fail on Linux */
  (void)pthread_mutex_init(&made->lock, NULL);
  (void)pthread_cond_init(&made->begin, NULL);
  (void)pthread_cond_init(&made->end, NULL);
  team_start_threads(made, size);
  if (made->started == size - 1) {
    *team = made;
    return DVI_OK;
  }
  const int started = made->started;
  dvi__team_destroy(&made);
  return dvi__fail(DVI_NO_MEMORY, "threads: the system starts %d of %d; ask for fewer", started,
                   size - 1);
}

void dvi__team_destroy(dvi__team **team)
{
  dvi__team *t = *team;
  if (t == NULL) return;
  team_begin_turn(t, 0, NULL, NULL);
  for (int i = 1; i <= t->started; i++) (void)pthread_join(t->members[i].thread, NULL);
  (void)pthread_mutex_destroy(&t->lock);
  (void)pthread_cond_destroy(&t->begin);
  (void)pthread_cond_destroy(&t->end);
  dvi__release(t->members);
  dvi__release(t);
  *team = NULL;
}
