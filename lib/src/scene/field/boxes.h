/* E and B of yee as vectors in the boxes of a grid. */
#ifndef DVI_SCENE_FIELD_BOXES_H
#define DVI_SCENE_FIELD_BOXES_H
#include <dvi/mesh.h>
#include <dvi/yee.h>

/* Give E or B in the boxes [boxes*3], box by box, each component as the mean of its values around
 * the box. If processes divide the grid, all of them call this, and the first one gets the vectors
 * of the whole grid. The others need no room for them. With a mesh of boxes that is a share, each
 * process gets those of its cells. */
dvi_status dvi__boxes_vectors(const dvi_yee_terms *terms, const dvi_mesh *mesh,
                              const dvi_march *march, dvi_march_form form, double *vector);

/* Agree with the processes that divide a grid, if there are any, whether all have succeeded. */
dvi_status dvi__boxes_agree(const dvi_yee_ranks *ranks, dvi_status status);

#endif
