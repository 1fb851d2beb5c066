#define _POSIX_C_SOURCE 200809L
#include "cli/crew.h"

#include <pthread.h>
#include <unistd.h>

void crew_work(long threads, void *(*work)(void *user), void *user)
{
  pthread_t other[CREW_MAX];
  int count = 0;
  while (count + 1 < threads && pthread_create(&other[count], NULL, work, user) == 0) count++;
  (void)work(user);
  while (count > 0) (void)pthread_join(other[--count], NULL);
}

long crew_cores(void)
{
  const long count = sysconf(_SC_NPROCESSORS_ONLN);
  return count < 1 ? 1 : count > CREW_MAX ? CREW_MAX : count;
}
