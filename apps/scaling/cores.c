#define _GNU_SOURCE
#include "scaling/cores.h"

#include <sched.h>
#include <unistd.h>

int cores_count(void)
{
  const long cores = sysconf(_SC_NPROCESSORS_ONLN);
  return cores > 0 ? (int)cores : 1;
}

#ifdef __linux__
void cores_keep(int number)
{
  static cpu_set_t allowed; /* before the first call */
  cpu_set_t one;
  if (CPU_COUNT(&allowed) == 0 && sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
  int left = number % CPU_COUNT(&allowed);
  size_t core = 0;
  while (!CPU_ISSET(core, &allowed) || left-- > 0) core++;
  CPU_ZERO(&one);
  CPU_SET(core, &one);
  (void)sched_setaffinity(0, sizeof one, &one);
}
#else
void cores_keep(int number)
{
  (void)number;
}
#endif
