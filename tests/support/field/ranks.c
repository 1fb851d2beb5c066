#define _POSIX_C_SOURCE 200809L
#include "support/field/ranks.h"

#include <check.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { RANKS = 16, NUMBERS = 1 << 14 };

/* Numbers on their way from one thread to another. */
typedef struct letter {
  struct letter *next;
  int count;
  double number[];
} letter;

/* What all threads see. */
typedef struct board {
  const dvi_mesh *whole;
  const int *owner;
  int count;
  pthread_barrier_t barrier;
  double *values[DVI_MESH_DIMENSION_MAX + 1]; /* of the whole mesh */
  int64_t integer[RANKS][NUMBERS];
  double number[RANKS][NUMBERS];
  void (*work)(const dvi_mesh *share, int rank, void *user);
  void (*work_on_boxes)(const dvi_yee_ranks *ranks, void *user);
  void *user;
  const double *sent[RANKS]; /* planes */
  int to[RANKS];             /* whom they go to */
  pthread_mutex_t mutex;     /* of the letters */
  pthread_cond_t arrival;
  letter *letter[RANKS][RANKS];
} board;

static int64_t letters, letter_numbers;

typedef struct rank {
  board *board;
  int rank;
  dvi_mesh *share;
  dvi_status status;
} rank;

static void meet(const rank *r)
{
  (void)pthread_barrier_wait(&r->board->barrier);
}

static int refresh(int degree, double *values, void *user)
{
  const rank *r = user;
  const int64_t *number = dvi_mesh_share_numbers(r->share, degree);
  const int *owner = dvi_mesh_share_owners(r->share, degree);
  double *all = r->board->values[degree];
  meet(r);
  for (int64_t i = 0; i < dvi_mesh_count(r->share, degree); i++)
    if (owner[i] == r->rank) all[number[i]] = values[i];
  meet(r);
  for (int64_t i = 0; i < dvi_mesh_count(r->share, degree); i++) values[i] = all[number[i]];
  return 0;
}

static int sum(int count, int64_t *number, void *user)
{
  const rank *r = user;
  meet(r);
  memcpy(r->board->integer[r->rank], number, (size_t)count * sizeof *number);
  meet(r);
  memset(number, 0, (size_t)count * sizeof *number);
  for (int other = 0; other < r->board->count; other++)
    for (int i = 0; i < count; i++) number[i] += r->board->integer[other][i];
  return 0;
}

static int largest(int count, double *number, void *user)
{
  const rank *r = user;
  meet(r);
  memcpy(r->board->number[r->rank], number, (size_t)count * sizeof *number);
  meet(r);
  for (int other = 0; other < r->board->count; other++)
    for (int i = 0; i < count; i++)
      if (r->board->number[other][i] > number[i]) number[i] = r->board->number[other][i];
  return 0;
}

static int send(int to, int count, const double *number, void *user)
{
  const rank *r = user;
  letter *made = malloc(sizeof *made + (size_t)count * sizeof *number);
  *made = (letter){.count = count};
  memcpy(made->number, number, (size_t)count * sizeof *number);
  (void)pthread_mutex_lock(&r->board->mutex);
  letter **last = &r->board->letter[r->rank][to];
  while (*last != NULL) last = &(*last)->next;
  *last = made;
  letters++;
  letter_numbers += count;
  (void)pthread_cond_broadcast(&r->board->arrival);
  (void)pthread_mutex_unlock(&r->board->mutex);
  return 0;
}

static int receive(int from, int most, double *number, int *count, void *user)
{
  const rank *r = user;
  (void)pthread_mutex_lock(&r->board->mutex);
  letter **first = &r->board->letter[from][r->rank], *taken;
  while (*first == NULL) (void)pthread_cond_wait(&r->board->arrival, &r->board->mutex);
  taken = *first;
  *first = taken->next;
  (void)pthread_mutex_unlock(&r->board->mutex);
  *count = taken->count;
  if (*count <= most) memcpy(number, taken->number, (size_t)*count * sizeof *number);
  free(taken);
  return *count > most;
}

void count_letters(int64_t *count, int64_t *numbers)
{
  *count = letters;
  *numbers = letter_numbers;
  letters = letter_numbers = 0;
}

/* Let all threads of a board run, each as a process. */
static void run_threads(board *shared, void *(*run)(void *user), rank *ranks)
{
  pthread_t thread[RANKS];
  ck_assert(pthread_barrier_init(&shared->barrier, NULL, (unsigned)shared->count) == 0);
  ck_assert(pthread_mutex_init(&shared->mutex, NULL) == 0);
  ck_assert(pthread_cond_init(&shared->arrival, NULL) == 0);
  for (int r = 0; r < shared->count; r++) {
    ranks[r] = (rank){.board = shared, .rank = r};
    ck_assert(pthread_create(thread + r, NULL, run, ranks + r) == 0);
  }
  for (int r = 0; r < shared->count; r++) ck_assert(pthread_join(thread[r], NULL) == 0);
  (void)pthread_barrier_destroy(&shared->barrier);
  for (int from = 0; from < shared->count; from++)
    for (int to = 0; to < shared->count; to++) ck_assert_ptr_null(shared->letter[from][to]);
  (void)pthread_cond_destroy(&shared->arrival);
  (void)pthread_mutex_destroy(&shared->mutex);
}

/* ---- meshes ---- */

static void *run(void *user)
{
  rank *r = user;
  const dvi_ranks ranks = {.size = sizeof ranks,
                           .rank = r->rank,
                           .count = r->board->count,
                           .refresh = refresh,
                           .sum = sum,
                           .largest = largest,
                           .user = r,
                           .send = send,
                           .receive = receive};
  r->status = dvi_mesh_cut(r->board->whole, r->board->owner, &ranks, &r->share);
  if (r->status == DVI_OK) r->board->work(r->share, r->rank, r->board->user);
  dvi_mesh_destroy(&r->share);
  return NULL;
}

void run_ranks(const dvi_mesh *whole, int count, const int *owner,
               void (*work)(const dvi_mesh *share, int rank, void *user), void *user)
{
  static board shared;
  rank ranks[RANKS];
  shared = (board){.whole = whole, .owner = owner, .count = count, .work = work, .user = user};
  for (int k = 0; k <= dvi_mesh_dimension(whole); k++)
    shared.values[k] = calloc((size_t)dvi_mesh_count(whole, k), sizeof(double));
  run_threads(&shared, run, ranks);
  for (int r = 0; r < count; r++) ck_assert_int_eq(ranks[r].status, DVI_OK);
  for (int k = 0; k <= dvi_mesh_dimension(whole); k++) free(shared.values[k]);
}

/* ---- boxes ---- */

static int pass(int to, int from, int64_t count, const double *sent, double *received, void *user)
{
  const rank *r = user;
  meet(r);
  r->board->sent[r->rank] = sent;
  r->board->to[r->rank] = to;
  meet(r);
  const int is_right = from < 0 || r->board->to[from] == r->rank;
  if (from >= 0) memcpy(received, r->board->sent[from], (size_t)count * sizeof *received);
  meet(r);
  return !is_right;
}

static void *run_boxes(void *user)
{
  rank *r = user;
  const dvi_yee_ranks ranks = {.size = sizeof ranks,
                               .rank = r->rank,
                               .count = r->board->count,
                               .pass = pass,
                               .sum = sum,
                               .largest = largest,
                               .user = r};
  r->board->work_on_boxes(&ranks, r->board->user);
  return NULL;
}

void run_box_ranks(int count, void (*work)(const dvi_yee_ranks *ranks, void *user), void *user)
{
  static board shared;
  rank ranks[RANKS];
  shared = (board){.count = count, .work_on_boxes = work, .user = user};
  run_threads(&shared, run_boxes, ranks);
}

/* ---- boxes, watched ---- */

static double wall_seconds(void)
{
  struct timespec now;
  (void)clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int pass_watched(int to, int from, int64_t count, const double *sent, double *received,
                        void *user)
{
  watched_ranks *w = user;
  const double start = wall_seconds();
  int failed = 9;
  if (!w->is_cut) failed = w->ranks->pass(to, from, count, sent, received, w->ranks->user);
  w->passes++;
  w->numbers += count;
  w->seconds += wall_seconds() - start;
  return failed;
}

static int sum_watched(int count, int64_t *number, void *user)
{
  const watched_ranks *w = user;
  return w->ranks->sum(count, number, w->ranks->user);
}

static int largest_watched(int count, double *number, void *user)
{
  const watched_ranks *w = user;
  return w->ranks->largest(count, number, w->ranks->user);
}

dvi_yee_ranks watch_ranks(watched_ranks *watched)
{
  dvi_yee_ranks ranks = *watched->ranks;
  ranks.pass = pass_watched;
  ranks.sum = sum_watched;
  ranks.largest = largest_watched;
  ranks.user = watched;
  return ranks;
}
