#include "shares/blocks.h"

#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "load/scene.h"
#include "shares/stand_in.h"

enum {
  MOST_TOGETHER = 6, /* steps, unless a program asks for more */
  MOST_BESIDE = 4    /* processes, along two axes */
};

struct block_cutter {
  dvi_yee_ranks ranks;
  problem *scene;
  int passes;            /* since the last steps began, also from nowhere */
  int64_t numbers;       /* that would have been received, */
  int messages;          /* in how many messages, */
  int from[MOST_BESIDE]; /* from which processes */
  int neighbours;
};

/* ---- one of many ---- */

static int pass(int to, int from, int64_t count, const double *sent, double *received, void *user)
{
  block_cutter *c = user;
  int known = 0;
  (void)to, (void)sent, (void)received;
  c->passes++;
  if (from < 0) return 0;
  c->numbers += count;
  c->messages++;
  while (known < c->neighbours && c->from[known] != from) known++;
  if (known == c->neighbours && known < MOST_BESIDE) c->from[c->neighbours++] = from;
  return 0;
}

int block_cutter_open(const char *path, const words *settings, block_cutter **cutter)
{
  const dvi_ranks alone = stand_in(0, 1);
  block_cutter *c = calloc(1, sizeof *c);
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

void block_cutter_close(block_cutter **cutter)
{
  if (*cutter != NULL) problem_destroy(&(*cutter)->scene);
  free(*cutter);
  *cutter = NULL;
}

/* ---- a block ---- */

dvi_status block_march(block_cutter *cutter, int rank, int count, double h, dvi_march **march)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = "yee", .step = isnan(h) ? 0 : h};
  cutter->ranks.rank = rank;
  cutter->ranks.count = count;
  return dvi_scene_march_create(cutter->scene->scene, &options, march);
}

/* Take steps at once. */
static dvi_status advance(block_cutter *c, dvi_march *march, int steps)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  c->passes = c->messages = c->neighbours = 0;
  c->numbers = 0;
  return dvi_march_advance(march, dvi_march_time(march) + steps * facts.step);
}

/* Find how many steps are taken after one exchange: they take as many passes as one step. */
static dvi_status count_together(block_cutter *c, dvi_march *march, int *together)
{
  dvi_status status = advance(c, march, *together = 1);
  const int passes = c->passes;
  while (status == DVI_OK && *together < MOST_TOGETHER) {
    status = advance(c, march, *together + 1);
    if (c->passes != passes) break;
    ++*together;
  }
  return status;
}

dvi_status block_count(block_cutter *cutter, dvi_march *march, block *counted)
{
  int together;
  dvi_status status = count_together(cutter, march, &together);
  if (status == DVI_OK) status = advance(cutter, march, together);
  if (status != DVI_OK) return status;
  *counted = (block){.values = dvi_march_size(march, DVI_FORM_E) +
                               dvi_march_size(march, DVI_FORM_B),
                     .together = together,
                     .ghosts = cutter->numbers,
                     .messages = cutter->messages,
                     .neighbours = cutter->neighbours};
  return status;
}
