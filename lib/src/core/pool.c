#define _XOPEN_SOURCE 700 /* pthread_sigmask */
#include "core/pool.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* Of a round's work for each thread: many enough that all end together, few enough that taking them costs nothing. */
enum { PORTIONS = 8 };

typedef struct seat {
  dvi__pool *pool;
  int number;
  pthread_t thread;
} seat;

struct dvi__pool {
  seat *seats; /* [made]: of the threads beside the caller's */
  int made;
  pthread_mutex_t lock;
  pthread_cond_t begin, end;
  long round; /* of work handed out; one more at each call */
  int busy;   /* threads that are not done with this round */
  int closing;
  /* The round's work. */
  dvi__work work;
  void *of;
  int count, portion; /* items that a thread takes at once */
  atomic_int next;
};

static void take_items(dvi__pool *pool, int thread)
{
  for (;;) {
    const int first = atomic_fetch_add_explicit(&pool->next, pool->portion, memory_order_relaxed);
    if (first >= pool->count) return;
    for (int item = first; item < pool->count && item - first < pool->portion; item++) pool->work(pool->of, thread, item);
  }
}

/* Wait for the round after this one; 0: there is none. */
static long next_round(dvi__pool *pool, long round)
{
  (void)pthread_mutex_lock(&pool->lock);
  while (pool->round == round && !pool->closing) (void)pthread_cond_wait(&pool->begin, &pool->lock);
  const long found = pool->closing ? 0 : pool->round;
  (void)pthread_mutex_unlock(&pool->lock);
  return found;
}

static void *serve(void *argument)
{
  const seat *own = argument;
  dvi__pool *pool = own->pool;
  for (long round = next_round(pool, 0); round != 0; round = next_round(pool, round)) {
    take_items(pool, own->number);
    (void)pthread_mutex_lock(&pool->lock);
    if (--pool->busy == 0) (void)pthread_cond_signal(&pool->end);
    (void)pthread_mutex_unlock(&pool->lock);
  }
  return NULL;
}

/* A program's handlers are meant for its own threads. */
static int make_threads(dvi__pool *pool, int wanted)
{
  sigset_t all, before;
  int failed = 0;
  (void)sigfillset(&all);
  (void)pthread_sigmask(SIG_SETMASK, &all, &before);
  for (; pool->made < wanted && failed == 0; pool->made += failed == 0) {
    seat *own = &pool->seats[pool->made];
    *own = (seat){.pool = pool, .number = pool->made + 1};
    failed = pthread_create(&own->thread, NULL, serve, own);
  }
  (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
  return failed;
}

dvi_status dvi__pool_create(int threads, dvi__pool **pool)
{
  *pool = NULL;
  dvi__pool *made = DVI_NEW(dvi__pool, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "threads: no memory");
  (void)pthread_mutex_init(&made->lock, NULL);
  (void)pthread_cond_init(&made->begin, NULL);
  (void)pthread_cond_init(&made->end, NULL);
  made->seats = DVI_NEW(seat, threads - 1);
  const int failed = made->seats != NULL ? make_threads(made, threads - 1) : 0;
  dvi_status status = DVI_OK;
  if (made->seats == NULL) status = dvi__fail(DVI_NO_MEMORY, "threads: no memory for %d", threads);
  if (failed != 0)
    status = dvi__fail(DVI_NO_MEMORY, "threads: the system gives %d of %d (error %d)", made->made + 1, threads, failed);
  if (status != DVI_OK) dvi__pool_destroy(&made);
  *pool = made;
  return status;
}

void dvi__pool_destroy(dvi__pool **pool)
{
  dvi__pool *p = *pool;
  if (p == NULL) return;
  (void)pthread_mutex_lock(&p->lock);
  p->closing = 1;
  (void)pthread_cond_broadcast(&p->begin);
  (void)pthread_mutex_unlock(&p->lock);
  for (int i = 0; i < p->made; i++) (void)pthread_join(p->seats[i].thread, NULL);
  (void)pthread_cond_destroy(&p->end);
  (void)pthread_cond_destroy(&p->begin);
  (void)pthread_mutex_destroy(&p->lock);
  dvi__release(p->seats);
  dvi__release(p);
  *pool = NULL;
}

void dvi__pool_run(dvi__pool *pool, int count, dvi__work work, void *of)
{
  (void)pthread_mutex_lock(&pool->lock);
  pool->work = work;
  pool->of = of;
  pool->count = count;
  pool->portion = count / (PORTIONS * (pool->made + 1)) + 1;
  atomic_store_explicit(&pool->next, 0, memory_order_relaxed);
  pool->busy = pool->made;
  pool->round++;
  if (pool->made > 0) (void)pthread_cond_broadcast(&pool->begin);
  (void)pthread_mutex_unlock(&pool->lock);
  take_items(pool, 0);
  (void)pthread_mutex_lock(&pool->lock);
  while (pool->busy > 0) (void)pthread_cond_wait(&pool->end, &pool->lock);
  (void)pthread_mutex_unlock(&pool->lock);
}
