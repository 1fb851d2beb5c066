/* The section joints: joints between coordinates that are motions, rotations or points, in the
 * machine as it starts. */
#include <string.h>

#include "scene/elaborate/elaborate.h"
#include "scene/elaborate/shape.h"
#include "scene/sections/sections.h"

/* ---- bodies ---- */

/* List the members of all coordinates as factors, one after the other. */
static bool list_bodies(dvi_scene *scene)
{
  int count = 0;
  for (int k = 0; k < scene->coordinate_count; k++) count += scene->coordinate[k].size;
  dvi_factor *body = dvi__arena_take(&scene->arena, (size_t)count, sizeof *body);
  if (body == NULL) return dvi__scene_no_memory(scene);
  scene->body = body;
  scene->body_count = count;
  for (int k = 0; k < scene->coordinate_count; k++) {
    const dvi__coordinate *x = &scene->coordinate[k];
    static const dvi_factor_kind kind[] = {[DVI__LINES] = DVI_RN,
                                           [DVI__ROTATION] = DVI_SO3,
                                           [DVI__MOTION] = DVI_SE3,
                                           [DVI__DIRECTION] = DVI_S2,
                                           [DVI__ANGLE] = DVI_U1};
    for (int i = 0; i < x->size; i++, body++)
      *body = (dvi_factor){.kind = kind[x->kind], .size = x->kind == DVI__LINES ? x->q.stride : 0};
  }
  return true;
}

/* Find the member of a family, counted from 0. */
static bool member_of(dvi_scene *scene, const dvi__coordinate *x, const dvi__subscripts *index,
                      int *member)
{
  *member = 0;
  for (int k = 0; k < index->count; k++) {
    const dvi__tree place = {.kind = DVI__SCALAR, .span = index->of[k]->span};
    const int extent = dvi__extent(x, k);
    int number;
    if (!dvi__tree_whole(scene, &place, "a number of a body", 1, &number)) return false;
    if (number > extent)
      return dvi__scene_refuse(scene, place.span, "%s has %d members here, and no %d", x->name,
                               extent, number);
    *member = *member * extent + number - 1;
  }
  return true;
}

static bool body_read(dvi_scene *scene, const dvi__expression *e, int *body)
{
  dvi__subscripts index;
  int member;
  *body = DVI_GROUND;
  if (e->form == DVI__FORM_NAME && strcmp(dvi__word_of(scene, e), "ground") == 0) return true;
  const dvi__coordinate *x = e->form == DVI__FORM_MEMBER ? NULL
                                                         : dvi__member_named(scene, e, &index);
  if (x == NULL)
    return dvi__scene_refuse(scene, e->span,
                             "a joint is between two bodies, coordinates such as B or B[1], or one "
                             "of them and the ground, as in [ground, B]");
  if (!member_of(scene, x, &index, &member)) return false;
  *body = member;
  for (const dvi__coordinate *before = scene->coordinate; before < x; before++)
    *body += before->size;
  return true;
}

static bool bodies_read(dvi_scene *scene, const dvi__tree *tree, int body[2])
{
  const dvi__expression *e;
  if (!dvi__tree_expression(scene, tree, &e)) return false;
  if (e->form != DVI__FORM_LIST || e->count != 2)
    return dvi__scene_refuse(scene, tree->span, "a joint is between two bodies, as in [ground, B]");
  return body_read(scene, e->part[0], &body[0]) && body_read(scene, e->part[1], &body[1]);
}

/* ---- points and axes ---- */

static bool vector_read(dvi_scene *scene, const dvi__tree *tree, double *numbers)
{
  const dvi__expression *e;
  dvi__context c;
  if (!dvi__tree_expression(scene, tree, &e) || !dvi__context_make(&c, scene, 0, "a joint"))
    return false;
  const dvi__value value = dvi__elaborate(&c, e);
  bool good = !dvi__failed(value);
  if (good && (value.shape.rank != 1 || value.shape.rows != 3))
    good = dvi__scene_refuse(scene, e->span, "this is a vector of three numbers");
  good = good && dvi__constants_of(&c, e, value, numbers);
  dvi__context_free(&c);
  return good;
}

/* ---- kinds ---- */

enum { AT = 1, TO = 2, AXIS = 4, SECOND_AXIS = 8, KINDS = 7 };

static const char *const vectors[] = {"at", "to", "axis", "second_axis"};
enum { VECTORS = sizeof vectors / sizeof *vectors };

/* The kinds of joints, the vectors that they need, and those that they may have. */
static const struct {
  const char *name;
  dvi_joint_kind kind;
  unsigned needs, may;
} kinds[KINDS] = {
    {"ball", DVI_BALL, AT, AT},
    {"hinge", DVI_HINGE, AT | AXIS, AT | AXIS},
    {"universal", DVI_UNIVERSAL, AT | AXIS | SECOND_AXIS, AT | AXIS | SECOND_AXIS},
    {"slider", DVI_SLIDER, AXIS, AT | AXIS},
    {"planar", DVI_PLANAR, AT | AXIS, AT | AXIS},
    {"weld", DVI_WELD, 0, AT},
    {"distance", DVI_DISTANCE, AT | TO, AT | TO},
};

static bool kind_read(dvi_scene *scene, const dvi__tree *tree, int *which)
{
  int found = 0;
  for (int k = 0; k < KINDS; k++)
    if (dvi__tree_find(tree, kinds[k].name) != NULL) {
      *which = k;
      found++;
    }
  return found == 1 ||
         dvi__scene_refuse(scene, tree->span,
                           "a joint is one of ball, hinge, universal, slider, planar, weld and "
                           "distance, as in {hinge: [ground, B], at: [0,0,0], axis: [0,1,0]}");
}

static bool vectors_read(dvi_scene *scene, const dvi__tree *tree, int which, dvi_joint *joint)
{
  double *const numbers[] = {joint->at, joint->to, joint->axis, joint->second_axis};
  for (int k = 0; k < VECTORS; k++) {
    const dvi__tree *given = dvi__tree_find(tree, vectors[k]);
    if (given == NULL && (kinds[which].needs & 1U << k) != 0)
      return dvi__scene_refuse(scene, tree->span, "a %s needs '%s', a vector in space",
                               kinds[which].name, vectors[k]);
    if (given == NULL) continue;
    if ((kinds[which].may & 1U << k) == 0)
      return dvi__scene_refuse(scene, given->span, "a %s has no '%s'", kinds[which].name,
                               vectors[k]);
    if (!vector_read(scene, given, numbers[k])) return false;
  }
  return true;
}

static bool joint_read(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree,
                       dvi_joint *joint)
{
  static const char *const known[] = {"ball",   "hinge", "universal",  "slider",
                                      "planar", "weld",  "distance",   "at",
                                      "to",     "axis",  "second_axis"};
  int which = 0;
  *joint = (dvi_joint){.name = key->text};
  if (!dvi__want_name(scene, key->text, key->span) || !dvi__want_mapping(scene, tree, "a joint") ||
      !dvi__want_keys(scene, tree, "a joint", KINDS + VECTORS, known) ||
      !kind_read(scene, tree, &which))
    return false;
  joint->kind = kinds[which].kind;
  return bodies_read(scene, dvi__tree_find(tree, kinds[which].name), joint->body) &&
         vectors_read(scene, tree, which, joint);
}

/* ---- the section ---- */

/* Append the constraints of the joints to those of the section constraints. */
static bool append_joints(dvi_scene *scene)
{
  const int count = scene->terms.holonomic_count;
  dvi_holonomic *list = dvi__arena_take(&scene->arena, (size_t)count + 1, sizeof *list);
  if (list == NULL) return dvi__scene_no_memory(scene);
  if (count > 0) memcpy(list, scene->holonomics, (size_t)count * sizeof *list);
  list[count] = *dvi_joints_constraints(scene->joints);
  scene->terms.holonomics = scene->holonomics = list;
  scene->terms.holonomic_count = count + 1;
  return true;
}

bool dvi__read_joints(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "joints")) return false;
  if (scene->terms.one_form != NULL || scene->terms.hamiltonian != NULL)
    return dvi__scene_refuse(scene, section->span,
                             "beside a %s there are no joints; they go with lagrangian, or "
                             "kinetic and potentials",
                             scene->form);
  if (section->count == 0) return dvi__scene_refuse(scene, section->span, "there are no joints");
  scene->joint = dvi__arena_take(&scene->arena, (size_t)section->count, sizeof *scene->joint);
  if (scene->joint == NULL) return dvi__scene_no_memory(scene);
  scene->joint_count = section->count;
  if (!list_bodies(scene)) return false;
  for (int k = 0; k < section->count; k++)
    if (!joint_read(scene, section->key[k], section->child[k], &scene->joint[k])) return false;
  const dvi_status status = dvi_joints_create(scene->body, scene->body_count, scene->joint,
                                              section->count, scene->q, &scene->joints);
  if (status == DVI_NO_MEMORY) return dvi__scene_no_memory(scene);
  if (status != DVI_OK)
    return dvi__complain(scene->complaint, status, section->span, "%s", dvi_last_error());
  return append_joints(scene);
}
