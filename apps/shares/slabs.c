#include "shares/slabs.h"

#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "load/scene.h"
#include "shares/stand_in.h"

enum { MOST_TOGETHER = 6 /* steps, unless a program asks for more */ };

struct slab_cutter {
  dvi_yee_ranks ranks;
  problem *scene;
  int way;         /* of the last planes */
  int exchanges;   /* begun so far */
  int64_t first;   /* numbers in the messages of the first of these, also from nowhere */
  int64_t numbers; /* that would have been received in the last one, */
  int messages;    /* and in how many messages, */
  int from[2];     /* from which processes, or -1 */
};

/* ---- one of many ---- */

static int pass(int way, int around, int64_t count, const double *sent, double *received,
                void *user)
{
  slab_cutter *c = user;
  const int from = (c->ranks.rank - way + c->ranks.count) % c->ranks.count,
            is_beside = from == c->ranks.rank - way;
  (void)sent;
  (void)received;
  if (way > 0 && c->way <= 0) {
    c->exchanges++;
    c->numbers = c->messages = 0;
    c->from[0] = c->from[1] = -1;
  }
  c->way = way;
  if (c->exchanges == 1) c->first += count;
  if (!around && !is_beside) return 0;
  c->numbers += count;
  c->messages++;
  c->from[way > 0] = from;
  return 0;
}

int slab_cutter_open(const char *path, const words *settings, slab_cutter **cutter)
{
  const dvi_ranks alone = stand_in(0, 1);
  slab_cutter *c = calloc(1, sizeof *c);
  *cutter = c;
  if (c == NULL) return library_error(DVI_NO_MEMORY);
  c->ranks = (dvi_yee_ranks){.size = sizeof c->ranks,
                             .count = 1,
                             .pass = pass,
                             .sum = alone.sum,
                             .largest = alone.largest,
                             .user = c};
  const dvi_scene_division division = {
      .size = sizeof division, .divide = stand_in_keep, .grid = &c->ranks};
  return scene_open_share(path, settings, &division, &c->scene);
}

void slab_cutter_close(slab_cutter **cutter)
{
  if (*cutter != NULL) problem_destroy(&(*cutter)->scene);
  free(*cutter);
  *cutter = NULL;
}

/* ---- a slab ---- */

dvi_status slab_march(slab_cutter *cutter, int rank, int count, double h, dvi_march **march)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = "yee", .step = isnan(h) ? 0 : h};
  cutter->ranks.rank = rank;
  cutter->ranks.count = count;
  return dvi_scene_march_create(cutter->scene->scene, &options, march);
}

/* Take steps at once. */
static dvi_status advance(slab_cutter *c, dvi_march *march, int steps)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  c->way = c->exchanges = 0;
  c->first = 0;
  return dvi_march_advance(march, dvi_march_time(march) + steps * facts.step);
}

/* The first exchange for one step has one plane of all that the first one for many has. */
dvi_status slab_count(slab_cutter *cutter, dvi_march *march, slab *counted)
{
  const int *from = cutter->from;
  dvi_status status = advance(cutter, march, 1);
  const int64_t plane = cutter->first;
  if (status == DVI_OK) status = advance(cutter, march, MOST_TOGETHER);
  if (status != DVI_OK) return status;
  const int together = plane > 0 ? (int)(cutter->first / plane) : 1;
  status = advance(cutter, march, together);
  *counted = (slab){.values = dvi_march_size(march, DVI_FORM_E) + dvi_march_size(march, DVI_FORM_B),
                    .together = together,
                    .ghosts = cutter->numbers,
                    .messages = cutter->messages,
                    .neighbours = (from[0] >= 0) + (from[1] >= 0 && from[1] != from[0])};
  return status;
}
