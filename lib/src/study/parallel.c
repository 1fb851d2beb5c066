/* Work on several threads. */
#define _POSIX_C_SOURCE 200809L /* sysconf */
#include <dvi/study.h>
#include <pthread.h>
#include <unistd.h>

/* The work of each thread. */
typedef struct shared_work {
  void (*work)(void *user);
  void *user;
} shared_work;

static void *take_part(void *user)
{
  const shared_work *shared = user;
  shared->work(shared->user);
  return NULL;
}

void dvi_study_parallel(int threads, void (*work)(void *user), void *user)
{
  pthread_t other[DVI_STUDY_THREADS_MAX];
  shared_work shared = {.work = work, .user = user};
  int count = 0;
  while (count + 1 < threads && count + 1 < DVI_STUDY_THREADS_MAX &&
         pthread_create(&other[count], NULL, take_part, &shared) == 0)
    count++;
  work(user);
  while (count > 0) (void)pthread_join(other[--count], NULL);
}

int dvi_study_cores(void)
{
  const long count = sysconf(_SC_NPROCESSORS_ONLN);
  return count < 1 ? 1 : count > DVI_STUDY_THREADS_MAX ? DVI_STUDY_THREADS_MAX : (int)count;
}
