/* A team of threads that waits for work. The threads are made once, because no step may make
 * one. */
#ifndef DVI_NUM_TEAM_H
#define DVI_NUM_TEAM_H
#include <dvi/status.h>

typedef struct dvi__team dvi__team;

/* Create a team of `size` members, of which the caller is one. size - 1 threads are started.
 * DVI_NO_MEMORY if the system has none left. */
dvi_status dvi__team_create(int size, dvi__team **team);
void dvi__team_destroy(dvi__team **team);

/* Call work(user, member) for members 0 to count-1 (count <= size), member 0 on the calling thread.
 * Return when all have ended. */
void dvi__team_run(dvi__team *team, int count, void (*work)(void *user, int member), void *user);

/* Call work(user, member, item) for items 0 to count-1, each once, in any order, on whichever
 * member is free, the caller among them. Return when all have ended. */
void dvi__team_share(dvi__team *team, int count, void (*work)(void *user, int member, int item),
                     void *user);

/* Wait a moment for another member. `waited` counts the waits in a row. A long wait leaves the
 * processor to others. */
void dvi__team_pause(int waited);

#endif
