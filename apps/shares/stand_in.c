#include "shares/stand_in.h"

#include <stdlib.h>
#include <string.h>

static int no_refresh(int degree, double *values, void *user)
{
  (void)degree;
  (void)values;
  (void)user;
  return 0;
}

static int own_sum(int count, int64_t *number, void *user)
{
  (void)count;
  (void)number;
  (void)user;
  return 0;
}

static int own_largest(int count, double *number, void *user)
{
  (void)count;
  (void)number;
  (void)user;
  return 0;
}

static int no_send(int to, int count, const double *number, void *user)
{
  (void)to;
  (void)count;
  (void)number;
  (void)user;
  return 0;
}

/* What never comes is a failure. No steps are taken where a process stands in for others. */
static int never_receive(int from, int most, double *number, int *count, void *user)
{
  (void)from;
  (void)most;
  (void)number;
  (void)count;
  (void)user;
  return 1;
}

dvi_ranks stand_in(int rank, int parts)
{
  return (dvi_ranks){.size = sizeof(dvi_ranks),
                     .rank = rank,
                     .count = parts,
                     .refresh = no_refresh,
                     .sum = own_sum,
                     .largest = own_largest,
                     .send = no_send,
                     .receive = never_receive};
}

dvi_status stand_in_keep(const dvi_mesh *mesh, dvi_mesh **share, void *user)
{
  const dvi_ranks alone = stand_in(0, 1);
  int *owner = calloc((size_t)dvi_mesh_count(mesh, dvi_mesh_dimension(mesh)), sizeof *owner);
  (void)user;
  if (owner == NULL) return DVI_NO_MEMORY;
  const dvi_status status = dvi_mesh_cut(mesh, owner, &alone, share);
  free(owner);
  return status;
}

static bool counts(const dvi_mesh *share, const form_of_share *form, int64_t cell)
{
  if (form->counts == NULL) return true;
  if (form->by_share) return form->counts[cell] != 0;
  return form->counts[dvi_mesh_share_numbers(share, form->degree)[cell]] != 0;
}

/* Count the values that others own, and these owners, by marks [parts]. */
static int64_t count_ghosts(const dvi_mesh *share, const form_of_share *form, int rank, int parts,
                            char *marked, int *owners)
{
  const int k = form->degree, *owner = dvi_mesh_share_owners(share, k);
  int64_t ghosts = 0;
  memset(marked, 0, (size_t)parts);
  *owners = 0;
  for (int64_t c = 0; c < dvi_mesh_count(share, k); c++) {
    if (owner[c] == rank || !counts(share, form, c)) continue;
    ghosts++;
    *owners += !marked[owner[c]];
    marked[owner[c]] = 1;
  }
  return ghosts;
}

bool stand_in_count(const dvi_mesh *share, const form_of_share *form, int rank, int parts,
                    mesh_division *division)
{
  const form_of_share cells = {.degree = dvi_mesh_dimension(share)};
  char *marked = malloc((size_t)parts);
  if (marked == NULL) return false;
  *division = (mesh_division){.partitioner = ranks_partitioner()};
  division->ghosts = count_ghosts(share, &cells, rank, parts, marked, &division->neighbours);
  division->owned = dvi_mesh_count(share, cells.degree) - division->ghosts;
  division->bytes_in = (int64_t)sizeof(double) *
                       count_ghosts(share, form, rank, parts, marked, &division->messages_in);
  free(marked);
  return true;
}
