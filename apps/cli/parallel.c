#define _POSIX_C_SOURCE 200809L
#include "cli/parallel.h"

#include <pthread.h>
#include <unistd.h>

void parallel_work(long threads, void *(*work)(void *user), void *user)
{
  pthread_t other[THREADS_MAX];
  int count = 0;
  while (count + 1 < threads && pthread_create(&other[count], NULL, work, user) == 0) count++;
  (void)work(user);
  while (count > 0) (void)pthread_join(other[--count], NULL);
}

long parallel_cores(void)
{
  const long count = sysconf(_SC_NPROCESSORS_ONLN);
  return count < 1 ? 1 : count > THREADS_MAX ? THREADS_MAX : count;
}
