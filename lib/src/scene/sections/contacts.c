/* The section contacts. */
#include "scene/elaborate/shape.h"
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

enum { TANGENTS_MOST = 2 };

/* Make the function value.w of an expression of 1 to `most` numbers. */
static bool contact_function(dvi_scene *scene, const dvi__tree *tree, unsigned may, int most,
                             const char *where, dvi__scene_term **term)
{
  dvi__context c;
  dvi__kernels list = {0};
  dvi__degree degree = {.degree = 0};
  const dvi__expression *e;
  if (!dvi__tree_expression(scene, tree, &e) ||
      !dvi__context_make(&c, scene, DVI__MENTIONS_Q | DVI__MENTIONS_T | may, where))
    return false;
  const dvi__value value = dvi__elaborate(&c, e);
  bool good = value.shape.rank >= 0;
  const int count = good ? dvi__value_size(value) : 0;
  if (good && count > most)
    good = dvi__scene_refuse(scene, e->span, "%s has %d numbers; it can have %d at most", where,
                             count, most);
  dvi__node total = dvi__constant(c.graph, 0);
  if (good) dvi__add_product(&c, value, NULL, (dvi__numbering){.base = 0}, &total);
  good = good && dvi__kernels_add_node(&c, total, &list);
  if (good && may != 0) {
    good = dvi__kernels_degree(scene, &list, DVI__VELOCITIES, &degree);
    if (good && degree.degree != 1)
      good = dvi__scene_refuse(scene, e->span,
                               "a tangent is linear in the velocities, as x' + r*a'; it is the "
                               "rate of slip");
  }
  good = good && dvi__kernels_function(scene, &list, count, term);
  dvi__context_free(&c);
  dvi__kernels_free(&list);
  return good;
}

/* Read a number that may be left out. */
static bool number_of(dvi_scene *scene, const dvi__tree *contact, const char *key, double *number)
{
  const dvi__tree *tree = dvi__tree_find(contact, key);
  *number = 0;
  return tree == NULL || dvi__tree_number(scene, tree, key, number);
}

static bool check_law(dvi_scene *scene, const dvi__tree *tree, const dvi_contact *contact)
{
  const dvi__tree *restitution = dvi__tree_find(tree, "restitution"),
                  *friction = dvi__tree_find(tree, "friction");
  if (restitution == NULL)
    return dvi__scene_refuse(scene, tree->span, "a contact needs 'restitution', from 0 to 1");
  if (!(contact->restitution >= 0 && contact->restitution <= 1))
    return dvi__scene_refuse(scene, restitution->span,
                             "the restitution is %g; it is a number from 0 to 1",
                             contact->restitution);
  if (!(contact->friction >= 0))
    return dvi__scene_refuse(scene, friction->span, "the friction is %g; it is a number from 0 on",
                             contact->friction);
  if (contact->friction == 0 || dvi__tree_find(tree, "tangent") != NULL) return true;
  return dvi__scene_refuse(scene, friction->span,
                           "friction needs 'tangent', the rate of slip, as x' of a block or x' + "
                           "r*a' of a disk on a floor");
}

static bool read_contact(dvi_scene *scene, const char *name, const dvi__tree *tree,
                         dvi_contact *contact)
{
  static const char *const known[] = {"gap", "restitution", "friction", "tangent", "hold"},
                           *const hold_word[] = {"no", "yes"};
  dvi__scene_term *gap, *tangent = NULL;
  double restitution, friction;
  int hold = 0;
  if (!dvi__want_mapping(scene, tree, "a contact") ||
      !dvi__want_keys(scene, tree, "a contact", 5, known))
    return false;
  const dvi__tree *phi = dvi__tree_find(tree, "gap"), *slip = dvi__tree_find(tree, "tangent"),
                  *holds = dvi__tree_find(tree, "hold");
  if (phi == NULL)
    return dvi__scene_refuse(scene, tree->span,
                             "a contact needs 'gap', the distance that stays 0 or more");
  if (!number_of(scene, tree, "restitution", &restitution) ||
      !number_of(scene, tree, "friction", &friction) ||
      (holds != NULL && !dvi__tree_word(scene, holds, "hold", 2, hold_word, &hold)))
    return false;
  *contact = (dvi_contact){
      .name = name, .restitution = restitution, .friction = friction, .hold = hold};
  return check_law(scene, tree, contact) && contact_function(scene, phi, 0, 1, "a gap", &gap) &&
         (slip == NULL ||
          contact_function(scene, slip, DVI__MENTIONS_V, TANGENTS_MOST, "a tangent", &tangent)) &&
         dvi__make_contact(scene, gap, tangent, contact);
}

static bool refuse_other_motions(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__refuse_factors(scene, section, "contacts")) return false;
  if (scene->terms.holonomic_count > 0 || scene->terms.nonholonomic_count > 0)
    return dvi__scene_refuse(scene, section->span,
                             "beside constraints there are no contacts; write the constraints as "
                             "springs, or choose coordinates without them");
  if (scene->terms.one_form == NULL && scene->terms.hamiltonian == NULL) return true;
  return dvi__scene_refuse(scene, section->span,
                           "beside a %s there are no contacts; they go with lagrangian, or kinetic "
                           "and potentials, of second degree in the velocities or more",
                           scene->form);
}

bool dvi__read_contacts(dvi_scene *scene, const dvi__tree *section)
{
  if (!dvi__want_mapping(scene, section, "contacts") || !refuse_other_motions(scene, section))
    return false;
  dvi_contact *list = dvi__arena_take(&scene->arena, (size_t)section->count + 1, sizeof *list);
  if (list == NULL) return dvi__scene_no_memory(scene);
  for (int k = 0; k < section->count; k++)
    if (!dvi__want_name(scene, section->key[k]->text, section->key[k]->span) ||
        !read_contact(scene, section->key[k]->text, section->child[k], &list[k]))
      return false;
  if (section->count > 0) scene->terms.contacts = scene->contacts = list;
  scene->terms.contact_count = section->count;
  return true;
}
