#include "bench/peer.h"

#include <string.h>

#include "cli/command.h"

const char *peer_name(int peer)
{
  return dvi_reference_name((dvi_reference_code)peer);
}

/* Compare a peer's name. "cvode" alone is its Adams formula, the better one for problems that are
 * not stiff, and comes first. */
static bool peer_is_named(const char *name, const char *text, size_t length)
{
  return (length == strlen(name) || length == strcspn(name, "-")) &&
         strncmp(name, text, length) == 0;
}

static int peer_read(const char *text, size_t length, peer_list *list)
{
  int peer = 0;
  while (peer_name(peer) != NULL && !peer_is_named(peer_name(peer), text, length)) peer++;
  const char *name = peer_name(peer);
  if (name == NULL && peer_is_named("bare", text, length)) {
    if (list->bare) return usage_error("bench: --against names bare twice");
    list->bare = true;
    return DONE;
  }
  if (name == NULL)
    return usage_error(
        "bench: --against knows cvode (cvode-adams), cvode-bdf, arkode, ida and bare, not '%.*s'",
        (int)length, text);
  for (int i = 0; i < list->count; i++)
    if (list->peer[i] == peer) return usage_error("bench: --against names %s twice", name);
  /* each peer is added once, and there are fewer than PEERS_MAX */
  list->peer[list->count++] = peer;
  return DONE;
}

int peers_read(const words *against, peer_list *list)
{
  int code = DONE;
  *list = (peer_list){0};
  for (int i = 0; i < against->count; i++)
    for (const char *text = against->word[i]; text != NULL && code == DONE;) {
      const size_t length = strcspn(text, ",");
      code = peer_read(text, length, list);
      text = text[length] == ',' ? text + length + 1 : NULL;
    }
  return code;
}

dvi_status peer_solve(int peer, const problem *scene, double t_end, double tolerance, double *q,
                      double *p, dvi_reference_report *report)
{
  dvi_reference_report unread;
  const dvi_reference_options options = {.code = (dvi_reference_code)peer,
                                         .relative_tolerance = tolerance};
  memcpy(q, scene->q, (size_t)scene->nq * sizeof *q);
  memcpy(p, scene->p, (size_t)scene->nv * sizeof *p);
  if (report == NULL) report = &unread;
  return dvi_reference_solve(scene->system, 0.0, t_end, q, p, &options, report);
}
