#include "shares/exchange.h"

#include <dvi/elastic.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "load/elastic.h"
#include "shares/share.h"

/* Return the unknowns of a step for each one of the field. */
static int stages_of(const char *method)
{
  return strncmp(method, "galerkin", 8) == 0 && strstr(method, "degree=1") == NULL ? 2 : 1;
}

exchange exchange_of(const problem *scene, const char *method)
{
  const dvi_elastic *solid = elastic_of(scene);
  if (strcmp(method, "yee") == 0)
    return (exchange){.kind = EXCHANGE_PLANES, .times = 1, .steps = 1};
  if (share_is_implicit(method))
    return (exchange){.kind = EXCHANGE_SOLUTION,
                      .degree = dvi_field_degree(dvi_scene_field(scene->scene)),
                      .times = stages_of(method),
                      .steps = 1};
  if (solid == NULL)
    return (exchange){.kind = EXCHANGE_FORM,
                      .degree = dvi_field_degree(dvi_scene_field(scene->scene)),
                      .times = 1,
                      .steps = 1};
  return (exchange){.kind = strncmp(method, "verlet", 6) == 0      ? EXCHANGE_PLACES
                            : strstr(method, "classes=no") != NULL ? EXCHANGE_EVENTS
                                                                   : EXCHANGE_SLOTS,
                    .times = dvi_mesh_dimension(dvi_elastic_mesh(solid)),
                    .steps = 1};
}

/* ---- what is foreseen ---- */

static void tell_slots(const dvi_march *march)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  if (facts.longest <= facts.step)
    (void)printf("an exchange comes before each step\n");
  else
    (void)printf("an exchange comes before each of the steps of %g in which a cell acts that has "
                 "nodes of several processes: 1 to %.0f in a step of %g\n",
                 facts.step, round(facts.longest / facts.step), facts.longest);
}

static void tell_planes(int steps, double bytes, double messages)
{
  if (steps > 1)
    (void)printf("%d steps together: all processes receive E and B of %d planes of each neighbour "
                 "once",
                 steps, steps);
  else
    (void)printf("a step: all processes receive a plane of B from the processes before and one of "
                 "E from the next");
  (void)printf(", %.0f bytes in %.0f messages together\n", bytes, messages);
}

static const char *form_sentence(const exchange *what)
{
  if (what->kind == EXCHANGE_FORM)
    return what->degree == 0 ? "a step: all processes receive the values of others at vertices once"
                             : "a step: all processes receive the values of others on edges once";
  return what->degree == 0 ? "a product with the matrix of a step: all processes receive the "
                             "unknowns of others at vertices once"
                           : "a product with the matrix of a step: all processes receive the "
                             "unknowns of others on edges once";
}

void exchange_tell(const exchange *what, const dvi_march *march, double bytes, double messages)
{
  static const char *const sentence[] = {
      [EXCHANGE_PLACES] = "a step: all processes receive where the nodes of others are once, "
                          "component by component",
      [EXCHANGE_SLOTS] = "an exchange: all processes receive where the nodes of others are, "
                         "component by component",
  };
  if (what->kind == EXCHANGE_EVENTS) {
    (void)printf("events: processes tell each other where the nodes of single cells are at their "
                 "next events\n");
    return;
  }
  if (what->kind == EXCHANGE_PLANES) {
    tell_planes(what->steps, bytes, messages);
    return;
  }
  const bool is_form = what->kind == EXCHANGE_FORM || what->kind == EXCHANGE_SOLUTION;
  const char *text = is_form ? form_sentence(what) : sentence[what->kind];
  (void)printf("%s, %.0f bytes in %.0f messages together\n", text, bytes, messages);
  if (what->kind == EXCHANGE_SLOTS && march != NULL) tell_slots(march);
  if (what->kind == EXCHANGE_SOLUTION)
    (void)printf("an iteration of %s has one product, two inner products, each a "
                 "sum over all processes of 568 bytes,\nand %s; how many there are "
                 "depends on the solution\n",
                 what->times == 1 ? "conjugate gradients" : "minimal residuals",
                 what->times == 1 ? "a multigrid cycle" : "a multigrid cycle for each stage");
}

/* ---- what is counted ---- */

/* Add up what each of the processes has received. Sums, iterations and their like are of all. */
static bool add_up(mesh_traffic *own)
{
  mesh_traffic *each = calloc((size_t)ranks_count(), sizeof *each);
  if (each == NULL) complain("out of memory");
  const bool good = ranks_agree(each != NULL ? DONE : FAILED) == DONE && each != NULL &&
                    ranks_gather(own, sizeof *own, each);
  own->messages = own->bytes = own->iteration_messages = own->iteration_bytes = 0;
  for (int r = 0; r < ranks_count() && good; r++) {
    own->messages += each[r].messages;
    own->bytes += each[r].bytes;
    own->iteration_messages += each[r].iteration_messages;
    own->iteration_bytes += each[r].iteration_bytes;
  }
  free(each);
  return good;
}

/* Count what so many units of time bring. */
static int count_units(dvi_march *march, double unit, int units, mesh_traffic *brought)
{
  mesh_traffic before = {0};
  *brought = before;
  ranks_received(&before);
  const dvi_status status = dvi_march_advance(march, dvi_march_time(march) + units * unit);
  if (status != DVI_OK) return library_error(status);
  ranks_received(brought);
  brought->messages -= before.messages;
  brought->bytes -= before.bytes;
  brought->agreements -= before.agreements;
  brought->sums -= before.sums;
  brought->gathers -= before.gathers;
  brought->corrections -= before.corrections;
  brought->iterations -= before.iterations;
  return add_up(brought) ? DONE : FAILED;
}

static void tell_solution(const mesh_traffic *t)
{
  (void)printf("counted in the first step: %lld corrections of %lld iterations together; %lld "
               "bytes in %lld messages, %lld sums over all processes, %lld gatherings of the "
               "coarsest unknowns\n",
               (long long)t->corrections, (long long)t->iterations, (long long)t->bytes,
               (long long)t->messages, (long long)t->sums, (long long)t->gathers);
  (void)printf("counted in an iteration: %lld bytes in %lld messages, %lld sums, %lld gatherings\n",
               (long long)t->iteration_bytes, (long long)t->iteration_messages,
               (long long)t->iteration_sums, (long long)t->iteration_gathers);
}

/* A run of a march has its own exchanges at the end, which the difference of two leaves out. */
static int count_difference(const exchange *what, dvi_march *march, double unit, double at_once)
{
  mesh_traffic one, three;
  int code = count_units(march, unit, 1, &one);
  if (code == DONE) code = count_units(march, unit, 3, &three);
  if (code != DONE) return code;
  const long long bytes = (three.bytes - one.bytes) / 2,
                  messages = (three.messages - one.messages) / 2;
  if (what->kind == EXCHANGE_SLOTS)
    (void)printf("counted in a step of %g: %g exchanges, %lld bytes in %lld messages\n", unit,
                 at_once > 0 ? (double)bytes / at_once : 0, bytes, messages);
  else
    (void)printf("counted in %d step%s: %lld bytes in %lld messages, %lld agreements of all "
                 "processes\n",
                 what->steps, what->steps > 1 ? "s" : "", bytes, messages,
                 (long long)(three.agreements - one.agreements) / 2);
  return DONE;
}

int exchange_count(const exchange *what, dvi_march *march, double bytes)
{
  dvi_march_facts facts;
  mesh_traffic brought;
  dvi_march_facts_of(march, &facts);
  if (what->kind == EXCHANGE_SOLUTION) {
    const int code = count_units(march, facts.step, 1, &brought);
    if (code == DONE) tell_solution(&brought);
    return code;
  }
  if (what->kind != EXCHANGE_EVENTS)
    return count_difference(what, march, facts.longest * what->steps, bytes);
  const int code = count_units(march, facts.longest, 1, &brought);
  if (code == DONE)
    (void)printf("counted in the longest step, %g: %lld bytes in %lld messages\n", facts.longest,
                 (long long)brought.bytes, (long long)brought.messages);
  return code;
}
