#include "traffic.h"

#include <petscsys.h>

dvi__traffic dvi__traffic_so_far(void)
{
  return (dvi__traffic){.messages = (int64_t)(petsc_irecv_ct + petsc_recv_ct),
                        .bytes = (int64_t)(petsc_irecv_len + petsc_recv_len),
                        .sums = (int64_t)petsc_allreduce_ct,
                        .gathers = (int64_t)petsc_gather_ct};
}

dvi__traffic dvi__traffic_since(dvi__traffic now, dvi__traffic before)
{
  return (dvi__traffic){.messages = now.messages - before.messages,
                        .bytes = now.bytes - before.bytes,
                        .sums = now.sums - before.sums,
                        .gathers = now.gathers - before.gathers};
}
